#pragma once

#include <memory>
#include <vector>

#include "wearwell/math/dual.h"
#include "wearwell/math/hermite_table.h"
#include "wearwell/models/bearing/contact.h"

namespace wearwell::bearing {

/// delta = depth/r as a function of x = ln(wear number), for one contact and one sigma: the inverse
/// geometry `depth_for`, tabulated because fits evaluate it millions of times. A table with nodes
/// 1/64 apart, whose slopes come from the implicit function theorem, d delta/dx = w/(dw/d delta),
/// and below it one of ln delta, which is nearly linear there: a relative error below 1e-9 (tests).
/// Outside both it solves directly.
class DepthCurve {
 public:
  using Point = HermiteTable::Point;

  /// With nodes from x = `from` to `to` (at most the limit). Throws InputError as `depth_for` does.
  DepthCurve(Contact contact, double sigma, double from, double to);

  /// delta and its slope, for x <= limit().
  Point operator()(double x) const;

  /// The x above which no depth exists, or the bearing is completely worn; infinite if there is
  /// none.
  double limit() const { return limit_; }

 private:
  Point solve(double x) const;

  Contact contact_;
  double sigma_, limit_;
  HermiteTable table_;
  HermiteTable logarithms_;  ///< of delta, below the table
};

/// The wear depth of one bearing after its revolutions under its load, as a function of the
/// logarithm of its wear rate k: d = r delta(ln k + ln(p_a n)).
struct DepthFunction {
  std::shared_ptr<const DepthCurve> curve;
  double radius = 0;       ///< of the journal, m
  double log_loading = 0;  ///< ln(p_a n), p_a in Pa

  /// The depth [m] and its slope by ln k.
  DepthCurve::Point depth_and_slope(double log_k) const {
    const DepthCurve::Point point = (*curve)(log_k + log_loading);
    return {radius * point.value, radius * point.slope};
  }

  /// The depth [m]; the bearing has none if `log_k` exceeds `limit()`.
  double depth(double log_k) const { return radius * (*curve)(log_k + log_loading).value; }

  template <int N>
  Dual<N> depth(const Dual<N>& log_k) const {
    const DepthCurve::Point point = (*curve)(log_k.a + log_loading);
    return Dual<N>(radius * point.value, radius * point.slope * log_k.v);
  }

  double limit() const { return curve->limit() - log_loading; }
};

/// One bearing under one load. All in SI, all positive.
struct Duty {
  Contact contact = Contact::stationary;
  double radius = 0;       ///< of the journal
  double clearance = 0;    ///< radial
  double pressure = 0;     ///< p_a
  double revolutions = 0;  ///< n
};

/// The depth functions of many duties; those of one contact and one clearance/radius share a curve
/// that covers their wear numbers for k within e^-10 and e^6 of `k`.
std::vector<DepthFunction> depth_functions(const std::vector<Duty>& duties, double k);

}  // namespace wearwell::bearing
