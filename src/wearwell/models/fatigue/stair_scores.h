#pragma once

#include "wearwell/models/fatigue/stair_design.h"

namespace wearwell::fatigue {

/// Rao's score tests of what a staircase's outcomes do that the distribution of the limit does not know, with median and
/// scale of the limit as nuisance parameters (Neyman's C(alpha)): each number is standard normal in large samples.
struct StairScores {
  /// The probability of failure on the scale of the standard distribution, w, bent by w^2 and by w^3 (Pregibon 1980,
  /// Applied Statistics 29, 15-24). 0 where there are too few levels.
  double skewed = 0, long_tailed = 0;
  double later =
      0;  ///< above 0 where items tested later bear less; 0 where the order of the tests is not known

  double shape() const { return skewed * skewed + long_tailed * long_tailed; }
  double drift() const { return later * later; }
};

StairScores stair_scores(const StairDesign& design, const StairOutcomes& outcomes,
                         StandardDistribution limit, double location, double scale);

}  // namespace wearwell::fatigue
