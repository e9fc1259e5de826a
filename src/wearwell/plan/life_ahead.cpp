#include "wearwell/plan/life_ahead.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wearwell::plan {

LifeAhead::LifeAhead(double passed, prognosis::WeightedLives lives)
    : passed_(passed), lives_(std::move(lives)) {
  // Linear between points, as the cdf is: trapezoids.
  const auto points = lives_.points();
  double before = 0, alive = 1;
  for (std::size_t i = 0; i < points.size() && std::isfinite(points[i]); ++i) {
    const double left = 1 - lives_.cdf(points[i]);
    const double all =
        i == 0 ? points[0] : used_.back() + (points[i] - before) * (alive + left) / 2;
    used_.push_back(all);
    before = points[i];
    alive = left;
  }
}

double LifeAhead::reached(double time) const {
  if (passed_ >= 1) return 1;
  return passed_ + (1 - passed_) * lives_.cdf(time);
}

double LifeAhead::used(double time) const {
  if (passed_ >= 1) return 0;
  const auto points = lives_.points().first(used_.size());
  if (points.empty() || time <= points.front()) return (1 - passed_) * time;
  const auto above = std::upper_bound(points.begin(), points.end(), time);
  const auto i = static_cast<std::size_t>(above - points.begin()) - 1;
  const double at = lives_.cdf(points[i]), then = lives_.cdf(time);
  // Beyond the last finite point the cdf is level.
  const double alive = i + 1 == used_.size() ? 1 - then : 1 - (at + then) / 2;
  return (1 - passed_) * (used_[i] + (time - points[i]) * alive);
}

double LifeAhead::latest(double p) const {
  constexpr double never = std::numeric_limits<double>::infinity();
  if (p >= 1) return never;
  if (passed_ >= 1) return 0;
  const double given_not = (p - passed_) / (1 - passed_);
  if (given_not <= 0) return 0;
  double time = lives_.quantile(given_not);
  // The cdf jumps at its first and last finite points: just before them the probability is smaller.
  if (std::isfinite(time) && lives_.cdf(time) > given_not * (1 + 1e-9))
    time = std::max(0.0, std::nextafter(time, 0.0));
  if (std::isfinite(time) && time >= lives_.points().back() && given_not >= 1) return never;
  return time;
}

std::size_t LifeAhead::points(double from, double to) const {
  const auto points = lives_.points();
  return static_cast<std::size_t>(std::upper_bound(points.begin(), points.end(), to) -
                                  std::upper_bound(points.begin(), points.end(), from));
}

}  // namespace wearwell::plan
