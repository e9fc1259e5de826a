#pragma once

#include "wearwell/infer/fit_check.h"
#include "wearwell/models/clutch/scatter.h"

namespace wearwell::clutch {

/// Whether the terms of the wear map and its scatter fit the points, by the tests of all studies (infer/fit_check.h). The draws
/// that these ask for are of the coefficients, normal about weighted least squares, as the posterior is for a flat prior and
/// this scatter. About least squares of equal weights, by which the map predicts, residuals of unequal scatter have variances
/// that the draws do not tell.
FitOutcome judge_map(const WearPoints& points, const WearMap& map, const ScatterLaw& scatter);

}  // namespace wearwell::clutch
