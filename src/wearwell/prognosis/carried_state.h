#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/input/source.h"

namespace wearwell::prognosis {

/// What `wearwell fit` saves for later commands, state.bin (docs/how-to/state.md): the study with
/// its data, and the posterior as nodes.
struct CarriedState {
  std::string model;    ///< key: "formula"
  bool trusted = true;  ///< whether the fit is trusted
  Source source;        ///< the study file, and its tables as read
  /// Names, as columns of the posterior; empty for a study without one (a clutch campaign).
  std::vector<std::string> parameters;
  WeightedDraws posterior;  ///< natural units, SI; nodes of the quadrature, or draws
};

/// The bytes of state.bin: versioned, the same on every machine, with a checksum.
std::string state_bytes(const CarriedState& state);

/// Reads them; `name` is the name in messages. Throws InputError if they have another version or
/// are damaged.
CarriedState state_of_bytes(std::string_view bytes, const std::string& name);

/// SHA-1 of all its contents.
std::string fingerprint_of(const CarriedState& state);

/// SHA-1 of the study's text and the posterior: a unit's state and its tracker must agree in it.
std::string population_fingerprint(const CarriedState& state);

/// Throws InputError if the posterior has other parameters.
void require_parameters(const CarriedState& state, const std::vector<std::string>& names);

/// Reads RESULT/state.bin or such a file. Throws InputError if there is none, or it has another
/// version or is damaged.
CarriedState read_state(const std::filesystem::path& result);

}  // namespace wearwell::prognosis
