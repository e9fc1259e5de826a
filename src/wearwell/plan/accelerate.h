#pragma once

#include <string>
#include <vector>

#include "wearwell/plan/answer.h"

namespace wearwell::plan {

/// Which accelerated life test predicts a life at the use condition best? Texts are as a user
/// writes them. Planning values may be intervals "a to b" (90 %) wherever a number may stand.
struct AccelerateQuestion {
  std::string family = "weibull";  ///< weibull, lognormal or loglogistic
  std::string relation =
      "arrhenius";           ///< arrhenius, eyring, inverse-power or linear: of log life to stress
  std::string use, highest;  ///< stresses, "50 degC"
  std::string lowest = {};   ///< lowest stress that may be tested; empty: the use condition
  std::string low = {};      ///< lower level of plans with three levels; empty: optimized
  std::string until;  ///< stop time of every test, "183 d"; shares of planning values are by then
  std::string stop =
      {};  ///< instead, of the lower, middle and highest level: "365 d, 250 d, 183 d"
  std::size_t specimens = 0;           ///< in all
  std::string goal = "B10";            ///< life at the use condition
  std::string shape = {}, sigma = {};  ///< Weibull shape; or the scale of log life, of any family
  /// Two of these, not both of the highest stress.
  std::string failing_at_use = {};      ///< share by the stop time, "0.1 %"
  std::string failing_at_highest = {};  ///< "90 %"
  std::string life_at_highest = {};     ///< median "60 d", or "B10 = 20 d"
  std::string activation_energy = {};   ///< arrhenius, eyring: "0.7 eV"
  std::string exponent = {};            ///< inverse-power: "4"
  std::string slope = {};               ///< linear: fall of log life per unit of stress, "0.05"
  std::string middle_share = "20 %";    ///< of the compromise plan
  std::size_t least_failures = 4;       ///< at each level: their probability is reported
};

/// Levels and allocation of an optimum, a compromise, a 4:2:1 and an equal plan, and how well each
/// predicts the goal. Throws InputError that names the option.
Answer accelerate(const AccelerateQuestion& question);

}  // namespace wearwell::plan
