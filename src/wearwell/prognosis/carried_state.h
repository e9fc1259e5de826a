#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/input/source.h"

namespace wearwell::prognosis {

/// What `wearwell fit` leaves for those who go on from it, state.bin (docs/how-to/state.md): the study with its data, and
/// the posterior as nodes.
struct CarriedState {
  std::string model;    ///< key: "formula"
  bool trusted = true;  ///< whether the fit was
  Source source;        ///< the study file, and its tables as they were read
  /// Names, as columns of the posterior; none of a study without one (a clutch campaign).
  std::vector<std::string> parameters;
  WeightedDraws posterior;  ///< natural, SI; nodes of the quadrature, or draws
};

/// The bytes of state.bin: versioned, the same on every machine, with a checksum.
std::string state_bytes(const CarriedState& state);

/// Reads them; `name` is what messages call them. Throws InputError where they are of another version, or damaged.
CarriedState state_of_bytes(std::string_view bytes, const std::string& name);

/// SHA-1 of all that it holds.
std::string fingerprint_of(const CarriedState& state);

/// Of the study's text and the posterior: what a unit's state must agree in with the tracker that takes it.
std::string population_fingerprint(const CarriedState& state);

/// Throws InputError where the posterior is not of these parameters.
void require_parameters(const CarriedState& state, const std::vector<std::string>& names);

/// Reads RESULT/state.bin or such a file. Throws InputError where there is none, it is of another version, or damaged.
CarriedState read_state(const std::filesystem::path& result);

}  // namespace wearwell::prognosis
