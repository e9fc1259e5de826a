#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/plan/answer.h"

namespace wearwell::plan {

/// Which test demonstrates a life? Texts are as a user writes them.
struct DemonstrateQuestion {
  std::string goal;                 ///< "B10 >= 1e6 cycles", "reliability >= 90 % at 1e6 cycles"
  std::string confidence = "90 %";  ///< that a test that passes shows
  std::string failures = "0";       ///< allowed: a number, or several: "0 to 3"
  std::string distribution = "weibull";  ///< weibull, lognormal or loglogistic
  std::string shape =
      {};  ///< Weibull: a number, "1.5 to 3" (90 % interval) or a prior; empty: unknown
  std::string sigma = {};  ///< the same for lognormal and loglogistic: scale of the log life
  std::optional<std::size_t> specimens = {};
  std::string time = {};  ///< of each test, "2e6 cycles"
  std::vector<std::string> truth =
      {};  ///< true lives at which the probability to pass is reported,
           ///< "B10 = 3e6 cycles"
  std::optional<std::size_t> sudden_death = {};  ///< groups, each tested to its first failure
};

/// Specimens for a time, time for a number of specimens, the confidence reached for both, or a
/// table of one against the other; and the probability to pass for true lives. Throws InputError
/// that names the option.
Answer demonstrate(const DemonstrateQuestion& question);

}  // namespace wearwell::plan
