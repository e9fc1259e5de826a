#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell::fatigue {

/// The tested range of a study, Pa and cycles.
struct TestedSpan {
  double alternating_low = 0, alternating_high = 0;
  double mean_low = 0, mean_high = 0;
  double life_low = 0, life_high = 0;
  int tests = 0, failures = 0;
};

/// An S-N study from its folder of results.
struct SnResult {
  std::string title, equation;
  bool trusted = true;
  SnLaw law;
  TestedSpan tested;
  Unit stress_unit;
  std::vector<std::string> parameters;  ///< names, in the order of SnLaw
  WeightedDraws posterior;              ///< without cells, SI
  std::string stress_si = "Pa";         ///< of the stress quantity
  Unit life_unit = {"cycles", 1, 0};    ///< unit of reported lives
};

/// The entry "fatigue" that `fit` writes to summary.json: the model's options and the tested range.
nlohmann::ordered_json sn_json(const SnLaw& law, const SnData& data);

/// A study from its summary.json and its saved state; `name` is its name in messages, `file` that of the
/// summary. Throws InputError as below.
SnResult sn_result_of(const nlohmann::ordered_json& summary, const std::filesystem::path& file,
                      const std::string& name,
                      const std::function<prognosis::CarriedState()>& state);

/// Reads summary.json and the posterior of state.bin. Throws InputError for a folder without
/// results, of another model, or of an earlier version.
SnResult read_sn_result(const std::filesystem::path& folder);

}  // namespace wearwell::fatigue
