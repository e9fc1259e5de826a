#include "wearwell/prognosis/predicted_reading.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/root.h"

namespace wearwell::prognosis {
namespace {

/// Where `target` of the predictive distribution of a reading's measured value lies, near `guess`,
/// to a twentieth of `scale`; NaN if nothing predicts it.
double predicted_value(const TrackedUnit& unit, Reading reading, std::size_t column, double target,
                       double guess, double scale) {
  const auto share = [&](double value) {
    reading.numbers[column] = value;
    const std::vector<PredictiveTails> tails = unit.predictive(reading);
    // A family of positive values refuses the others.
    if (tails.empty()) return value > 0 ? std::nan("") : -target;
    return tails.front().below / (tails.front().below + tails.front().above) - target;
  };
  constexpr double close = 0.05, far = 1e6;
  return solve_increasing(share, guess, scale, {close * scale, 1e-9}, guess - far * scale,
                          guess + far * scale);
}

}  // namespace

Reading alone(const Tracker& tracker, const WatchedColumns& watched, Reading reading) {
  const auto columns = tracker.columns();
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].measured && i != watched.measured) reading.numbers[i] = std::nan("");
  return reading;
}

double scale_of_reading(const Tracker& tracker, const WatchedColumns& columns, double measured) {
  constexpr double part = 1e-2;
  const double limit = std::abs(tracker.limit().si());
  return part * (columns.level && limit > 0 ? limit : std::max(std::abs(measured), 1e-300));
}

bool predict(const TrackedUnit& unit, const Reading& reading, const WatchedColumns& columns,
             double scale, ReadingSince& values) {
  constexpr double one_sd = 0.158655;
  const auto at = [&](double target, double guess) {
    return predicted_value(unit, reading, *columns.measured, target, guess, scale);
  };
  values.expected = at(0.5, values.measured);
  if (!std::isfinite(values.expected)) return false;
  values.spread = (at(1 - one_sd, values.expected) - at(one_sd, values.expected)) / 2;
  return std::isfinite(values.spread) && values.spread > 0;
}

double two_sided(std::span<const PredictiveTails> tails) {
  double least = std::nan("");
  for (const PredictiveTails& each : tails)
    least = std::fmin(least, std::min(each.below, each.above));
  return std::fmin(1, 2 * static_cast<double>(tails.size()) * least);
}

}  // namespace wearwell::prognosis
