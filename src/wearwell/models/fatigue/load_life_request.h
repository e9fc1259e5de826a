#pragma once

#include <string>
#include <vector>

#include "wearwell/models/fatigue/counting_choice.h"
#include "wearwell/models/fatigue/load_life_report.h"

namespace wearwell::fatigue {

/// The options of `wearwell fatigue life`, as a user writes them.
struct LoadLifeRequest {
  CountingChoice counting = {};  ///< a signal, or a table of counted cycles
  std::string scale = {}, rule = {}, knee = {}, block = {};
  std::string damage_sum = "1 x/ 1.34";
  std::vector<double> b_lives = {1, 10, 50};  ///< percentages
  double confidence = 0.9;
};

/// Damage and life of one study under this history. Throws InputError that names option, file, row or
/// column; Cancelled.
LoadLifeReport load_life_of(const LoadLifeRequest& request, SnResult result);

}  // namespace wearwell::fatigue
