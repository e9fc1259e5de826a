#pragma once

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/bearing/wear_fit.h"

namespace wearwell::bearing {

/// The score of each inspection in its predictive distribution. If bearings vary, given the earlier
/// rows of the same bearing: an integral over the bearing's k, on a grid, to about 0.02 of a score.
Scores wear_scores(const WearModel& model, const Inspections& inspections);

}  // namespace wearwell::bearing
