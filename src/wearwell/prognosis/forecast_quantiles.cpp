#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

ForecastQuantiles quantiles_of(const Forecast& forecast) {
  const bool any = !forecast.remaining.points().empty();
  const auto remaining = [&](double p) { return any ? forecast.remaining.quantile(p) : 0; };
  return {forecast.now,    forecast.level05, forecast.level50, forecast.level95,
          forecast.passed, remaining(0.05),  remaining(0.5),   remaining(0.95)};
}

}  // namespace wearwell::prognosis
