#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// What the tests of a study spanned, Pa and cycles.
struct TestedSpan {
  double alternating_low = 0, alternating_high = 0;
  double mean_low = 0, mean_high = 0;
  double life_low = 0, life_high = 0;
  int tests = 0, failures = 0;
};

/// An S-N study as its folder of results keeps it.
struct SnResult {
  std::string title, equation;
  bool trusted = true;
  SnLaw law;
  TestedSpan tested;
  Unit stress_unit;
  std::vector<std::string> parameters;  ///< names, as SnLaw counts them
  WeightedDraws posterior;              ///< without cells, SI
  std::string stress_si = "Pa";         ///< of the stress, or of what stands for it
  Unit life_unit = {"cycles", 1, 0};    ///< in which the study tells lives
};

/// What `fit` writes as "fatigue" into summary.json: the law's choices and what was tested.
nlohmann::ordered_json sn_json(const SnLaw& law, const SnData& data);

/// Reads summary.json and the posterior of state.bin. Throws InputError: no folder of results, of another model, of an
/// earlier version.
SnResult read_sn_result(const std::filesystem::path& folder);

}  // namespace wearwell::fatigue
