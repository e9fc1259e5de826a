#pragma once

#include <cmath>
#include <vector>

namespace wearwell {

/// A smooth function tabulated with its slope at evenly spaced points: cubic Hermite between them,
/// with an error of spacing^4/384 times its fourth derivative.
class HermiteTable {
 public:
  struct Point {
    double value;
    double slope;
  };

  HermiteTable() = default;

  /// `f` returns the Point of any x in [from, to].
  template <class F>
  HermiteTable(double from, double to, double points_per_unit, const F& f)
      : from_(from), per_unit_(points_per_unit) {
    const double intervals = std::floor((to - from) * points_per_unit);
    for (double i = 0; i <= intervals; ++i) {
      const Point p = f(from + i / per_unit_);
      nodes_.push_back({p.value, p.slope / per_unit_});
    }
  }

  bool covers(double x) const {
    const double at = (x - from_) * per_unit_;
    return at >= 0 && at + 1 < static_cast<double>(nodes_.size());
  }

  /// Requires an x inside the table.
  Point operator()(double x) const {
    const double at = (x - from_) * per_unit_;
    const auto i = static_cast<std::size_t>(at);
    const double t = at - static_cast<double>(i);
    const Point &a = nodes_[i], &b = nodes_[i + 1];
    const double rise = b.value - a.value;
    const double c2 = 3 * rise - 2 * a.slope - b.slope, c3 = a.slope + b.slope - 2 * rise;
    return {a.value + t * (a.slope + t * (c2 + t * c3)),
            per_unit_ * (a.slope + t * (2 * c2 + 3 * t * c3))};
  }

 private:
  double from_ = 0, per_unit_ = 1;
  std::vector<Point> nodes_;  // slopes by node, not by x
};

}  // namespace wearwell
