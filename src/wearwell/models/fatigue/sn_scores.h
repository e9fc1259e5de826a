#pragma once

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/fatigue/life_test.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// The score of each test in the distribution of its life: of a failure its quantile, of a run-out,
/// a left-censored test or an interval its bounds. Tests of one row share one.
Scores sn_scores(const SnLaw& law, const LifeTests& tests);

}  // namespace wearwell::fatigue
