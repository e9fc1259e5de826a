#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell::fatigue {

/// Tests under one stress [Pa] with the same outcome: failed before a number of cycles, or not.
struct StairTest {
  double stress = 0;
  bool failed = false;
  int count = 1;
};

/// The likelihood of log10 of the median (location) fatigue limit [Pa] and of its scale: a test
/// fails if its item's limit is below the stress. Terms are those of one test of each row.
std::shared_ptr<const LogDensity> staircase_likelihood(StandardDistribution limit,
                                                       std::vector<StairTest> tests);

/// Dixon and Mood's estimate (1948) from an up-and-down sequence with equal steps, in Pa.
struct DixonMood {
  std::string problem;  ///< reason why there is none; nothing below is set then
  double mean = 0, sd = 0, step = 0;
  bool of_failures = false;  ///< the rarer event, which the method counts
  bool crude_sd = false;     ///< the formula does not hold: the method then gives 0.53 of a step
};
DixonMood dixon_mood(const std::vector<StairTest>& tests);

}  // namespace wearwell::fatigue
