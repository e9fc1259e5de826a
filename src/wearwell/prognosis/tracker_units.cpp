#include "wearwell/prognosis/tracker_units.h"

#include <algorithm>
#include <cmath>

namespace wearwell::prognosis {

TrackerUnits::TrackerUnits(const Tracker& tracker)
    : tracker_(tracker),
      axis_(tracker.axis().unit),
      level_(tracker.limit().unit),
      watched_(watched_columns(tracker)) {}

Interval TrackerUnits::level(const ForecastQuantiles& forecast) const {
  return {level(forecast.level05), level(forecast.level50), level(forecast.level95)};
}

Interval TrackerUnits::level(const Forecast& forecast) const {
  return level(quantiles_of(forecast));
}

Interval TrackerUnits::remaining(const ForecastQuantiles& forecast) const {
  return {along(forecast.remaining05), along(forecast.remaining50), along(forecast.remaining95)};
}

Interval TrackerUnits::remaining(const Forecast& forecast) const {
  return remaining(quantiles_of(forecast));
}

double TrackerUnits::b10(const Forecast& forecast) const {
  constexpr double tenth = 0.1;
  return forecast.remaining.points().empty() ? 0 : along(forecast.remaining.quantile(tenth));
}

std::optional<double> TrackerUnits::measured(const std::vector<double>& numbers) const {
  const auto& column = watched_.level;
  if (!column || *column >= numbers.size() || std::isnan(numbers[*column])) return {};
  return level(numbers[*column]);
}

double risk_within(const Forecast& forecast, double horizon) {
  if (forecast.remaining.points().empty()) return std::min(forecast.passed, 1.0);
  // Sums of weights are 1 up to rounding.
  return std::clamp(forecast.passed + (1 - forecast.passed) * forecast.remaining.cdf(horizon), 0.0,
                    1.0);
}

}  // namespace wearwell::prognosis
