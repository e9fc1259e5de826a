#pragma once

#include "wearwell/base/unit.h"
#include "wearwell/bayes/parameter.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/models/fatigue/staircase.h"

namespace wearwell::fatigue {

/// Data of the check `fit` of a staircase, which tests whether outcomes follow the distribution of the limit from level to
/// level, and whether the strength of items drifts with the order of the tests.
struct StairFit {
  StandardDistribution limit = StandardDistribution::normal;
  std::vector<StairTest> tests;
  Distribution log10_limit, sigma_limit;  ///< priors
  Unit unit;                              ///< of reported stresses
};

/// A p value is the share of tests simulated from the posterior, by the rule of the same sequence, that have as large a
/// statistic (posterior predictive p value, Gelman et al. 2013, section 6.3). Median and scale are estimated again from each
/// of them, so that the statistic hardly depends on their true values and p is nearly uniform under a right model. Equal
/// outcomes under equal stresses are natural: copies are not looked for.
FitOutcome judge_staircase(const StairFit& data, const WeightedDraws& posterior);

Check staircase_fit_check(const StairFit& data, const WeightedDraws& posterior);

}  // namespace wearwell::fatigue
