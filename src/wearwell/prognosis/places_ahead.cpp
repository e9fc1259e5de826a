#include <cmath>

#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

std::vector<double> places_ahead(const Forecast& forecast, std::size_t count) {
  const WeightedLives& lives = forecast.remaining;
  if (lives.points().empty() || count < 2) return {};
  constexpr double last = 0.95, step = 0.05;
  double middle = lives.quantile(0.5), end = lives.quantile(last);
  for (double p = last - step; !std::isfinite(end) && p > 0.01; p -= step) end = lives.quantile(p);
  if (!std::isfinite(end)) end = forecast.now;
  if (!(end > 0)) return {};
  if (!std::isfinite(middle) || !(middle < end)) middle = 0.5 * end;
  std::vector<double> places;
  const auto half = static_cast<double>(count / 2), rest = static_cast<double>(count) - half;
  for (std::size_t i = 0; i <= count; ++i) {
    const auto k = static_cast<double>(i);
    const double way = k <= half ? middle * k / half : middle + (end - middle) * (k - half) / rest;
    places.push_back(forecast.now + way);
  }
  return places;
}

}  // namespace wearwell::prognosis
