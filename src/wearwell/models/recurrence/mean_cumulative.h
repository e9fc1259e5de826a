#pragma once

#include <utility>
#include <vector>

#include "wearwell/models/recurrence/recurrence_data.h"

namespace wearwell::recurrence {

/// The mean cumulative function at one age of failures, SI.
struct MeanCumulativeStep {
  double age = 0;
  std::size_t failures = 0;  ///< at this age
  std::size_t at_risk = 0;   ///< units under observation
  double mean = 0;           ///< failures per unit up to this age
  double se = 0;             ///< robust standard error
  double low = 0, high = 0;  ///< pointwise bounds
};

/// Nelson's estimate of the mean number of failures per unit, with the robust variance that makes no assumption on the
/// process (Lawless and Nadeau 1995, Technometrics 37, 158-168; Meeker and Escobar 1998, equations 16.1 and 16.2) and
/// bounds of `level` on the logarithmic scale, which are positive: mean exp(+-z se/mean). A unit is at risk after the start
/// of its observation and up to its end. Failures are counted from the first age at which a unit is at risk. From the first
/// step with one unit at risk on, the standard error and bounds are NaN: one unit shows no variance.
std::vector<MeanCumulativeStep> mean_cumulative(const std::vector<UnitHistory>& units,
                                                double level);

/// The ages between the first and the last observation at which no unit was under observation, SI: the mean cumulative
/// function lacks the failures there.
std::vector<std::pair<double, double>> unobserved_ages(const std::vector<UnitHistory>& units);

}  // namespace wearwell::recurrence
