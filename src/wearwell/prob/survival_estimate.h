#pragma once

#include <span>
#include <vector>

#include "wearwell/prob/response.h"

namespace wearwell {

/// One step of a nonparametric estimate of survival.
struct SurvivalStep {
  /// The failures of this step lie above `from`, up to `at`; both are equal for exact lives.
  /// `from` is -infinity below a left-censored life.
  double from = 0, at = 0;
  double failed = 0, at_risk = 0;  ///< items; 0 for Turnbull's estimate, which has no risk sets
  double survival = 1;             ///< from `at` on
  double error = 0;                ///< its standard error; NaN if there is none
};

enum class SurvivalMethod { none, kaplan_meier, turnbull };

/// A nonparametric estimate of survival, its steps in ascending order.
struct SurvivalEstimate {
  SurvivalMethod method = SurvivalMethod::none;  ///< none: intervals and delayed entries together
  std::vector<SurvivalStep> steps;               ///< empty without failures
};

/// For exact lives, run-outs and delayed entries: the estimate of Kaplan and Meier (1958), with
/// Greenwood's standard error. A run-out at a life counts as at risk there. With interval- or
/// left-censored lives: Turnbull's (1976), with the standard error from the observed information of
/// its steps (Meeker and Escobar 1998, sec. 3.10), up to 300 steps. `counts` is the number of items
/// per observation.
SurvivalEstimate survival_estimate(std::span<const Response> responses,
                                   std::span<const int> counts);

struct SurvivalBand {
  double lower, upper;
};

/// Pointwise bounds: the normal approximation of log(-log survival) with `z` standard errors
/// (Kalbfleisch and Prentice 2002, sec. 1.4). NaN where survival is 0 or 1 or has no standard
/// error.
SurvivalBand log_log_band(const SurvivalStep& step, double z);

}  // namespace wearwell
