#pragma once

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/fatigue/life_test.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// Where each test lies in the law of its life: of a failure the place, of a run-out, a left-censored
/// test or an interval what it lies between. Tests of one row share one.
Scores sn_scores(const SnLaw& law, const LifeTests& tests);

}  // namespace wearwell::fatigue
