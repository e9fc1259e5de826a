#pragma once

#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/recurrence/process.h"

namespace wearwell::recurrence {

/// A unit from which failures are counted on: its age, and how long ago it was last repaired (its age, if never). SI.
struct UnitState {
  double age = 0, since_repair = 0;
};
UnitState state_at_end(const UnitHistory& unit);

/// Failures to come in a time: their expected number with its credible interval, and the prediction interval of the number,
/// in whole numbers.
struct Forecast {
  double expected = 0, low = 0, high = 0;
  double count_low = 0, count_high = 0;
  double any = 0;  ///< probability of at least one
};

/// Failures of all `units` together within `ahead` [SI] from their states on. Under the power law the number is a mixture of
/// Poisson distributions over the posterior; a renewal process is simulated with 4000 futures, and its expected number is
/// that of each future's parameters by the renewal equation. Each end of the intervals leaves `outside` beyond it.
Forecast forecast(const Process& process, const WeightedDraws& draws,
                  const std::vector<UnitState>& units, double ahead, double outside = 0.05);

/// The predictive distribution of the time until the next failure of a unit: quantile `p` [SI].
double time_to_failure(const Process& process, const WeightedDraws& draws, const UnitState& unit,
                       double p);

/// Expected number of failures of a new unit until each of `ages`, ascending, under the parameters x.
std::vector<double> expected_failures(const Process& process, const double* x,
                                      const std::vector<double>& ages);

}  // namespace wearwell::recurrence
