#pragma once

#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/models/fatigue/standard_fit.h"

namespace wearwell {

/// Under one stress: lives [cycles] by the posterior and by the standards, one for each of
/// `design_levels`; those of the standards are empty if their line cannot be fitted.
struct CurvePoint {
  double stress = 0, mean = 0;  ///< Pa, alternating and mean
  double median = 0;
  std::vector<double> posterior, iso, owen;
  double band = 0;  ///< lower end of E739's 95 % band of the median
};

/// From the highest stress of the tests to the lowest, evenly in its logarithm.
std::vector<CurvePoint> curve_points(const fatigue::SnLaw& law, const SnData& data,
                                     const WeightedDraws& draws, const StandardFit& standard);

}  // namespace wearwell
