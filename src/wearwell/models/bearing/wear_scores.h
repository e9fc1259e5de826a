#pragma once

#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/bearing/wear_fit.h"

namespace wearwell::bearing {

/// Where each inspection lies in the law of its measurement. Where bearings differ, in the law that
/// the earlier rows of the same bearing leave for it: an integral over the bearing's own k, on a
/// grid, to about 0.02 of a score.
Scores wear_scores(const WearModel& model, const Inspections& inspections);

}  // namespace wearwell::bearing
