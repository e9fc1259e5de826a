#include "wearwell/models/bearing/inspected.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"
#include "wearwell/models/bearing/wear_number.h"

namespace wearwell::bearing {
namespace {

// With more rows a table is faster than their sum.
constexpr std::size_t rows_for_table = 8;

// ln k of a depth that may be outside the geometry.
double log_k_of(const Duty& duty, double depth, double limit) {
  if (duty.contact == Contact::stationary && depth >= 2 * duty.radius) return limit;
  if (duty.contact == Contact::journal && depth > duty.radius) return limit;
  return std::min(limit, single_log_k(duty, depth).value_or(-infinity));
}

// A lognormal depth y with standard deviation sigma has its maximum likelihood where the mean is
// about y (or sqrt(sigma y), if sigma is larger). For smaller means there is another peak, low and
// wide: far below y the distribution becomes so skewed that y is not unusual. With L =
// log(sigma/mean) and A = log(y/sigma) the log-density goes with -(A + 2L)^2/(4L): its peak is at L
// = A/2.
double log_density_far_below(double y, double sigma) {
  if (!(sigma < y)) return -infinity;
  constexpr double margin = 0.7;  // of that approximation
  return lognormal_log_density(std::log(y), sigma * std::sqrt(sigma / y), sigma) + margin;
}

}  // namespace

std::optional<double> single_log_k(const Duty& duty, double depth) {
  if (!(depth > 0)) return {};
  const double w = wear_number(duty.contact, duty.clearance / duty.radius, depth / duty.radius);
  return std::log(w / (duty.pressure * duty.revolutions));
}

Inspected::Inspected(ObservationFamily family, std::vector<DepthFunction> curves,
                     std::vector<Duty> duties, std::vector<double> depths)
    : family_(family),
      curves_(std::move(curves)),
      duties_(std::move(duties)),
      depths_(std::move(depths)),
      limit_(infinity),
      lowest_(infinity),
      highest_(-infinity),
      peak_(-infinity) {
  double sum = 0;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    limit_ = std::min(limit_, curves_[i].limit());
    const double own = single_log_k(duties_[i], depths_[i]).value_or(-infinity);
    lowest_ = std::min(lowest_, own);
    highest_ = std::max(highest_, own);
    if (std::isinf(own)) continue;
    const double weight = std::pow(curves_[i].depth(Dual<1>(own, 0)).v[0], 2);
    sum += weight * own;
    information_ += weight;
  }
  if (information_ > 0) peak_ = std::min(sum / information_, limit_);
  if (family_ == ObservationFamily::lognormal) {
    observations_.emplace(family_, depths_);
    return;
  }
  find_wells();
  if (size() < rows_for_table) return;
  // Around the peak, where the sum is small and matters.
  constexpr double reach = 6, nodes_per_unit = 512;
  const double middle = std::isinf(peak_) ? std::min(limit_, highest_) : peak_;
  if (std::isinf(middle)) return;
  squares_ = HermiteTable(middle - reach, std::min(middle + reach, limit_), nodes_per_unit,
                          [this](double x) { return sum_of_squares(x); });
}

// The residual sum of squares at ln k, with its slope by ln k.
HermiteTable::Point Inspected::sum_of_squares(double log_k) const {
  HermiteTable::Point sum{0, 0};
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const DepthCurve::Point depth = curves_[i].depth_and_slope(log_k);
    const double excess = depth.value - depths_[i];
    sum.value += excess * excess;
    sum.slope += 2 * excess * depth.slope;
  }
  return sum;
}

// The minima of the sum of squares lie among the values of ln k of the single depths: there is one,
// unless inspections of different geometry contradict each other. Depths without wear have no
// finite value, so the search extends as far below as they may pull.
void Inspected::find_wells() {
  double low = lowest_;
  const double high = highest_;
  for (const double depth : depths_) {
    if (!(depth > 0)) least_squares_ += depth * depth;  // no ln k comes closer
  }
  if (std::isinf(high)) return;  // no wear at all: decreasing everywhere
  constexpr double far = 30;     // in ln k: depths have fallen to less than a millionth
  if (std::isinf(low)) low = high - far;
  if (!(high > low)) {  // one inspection determines it
    lowest_ = highest_ = peak_;
    return;
  }
  constexpr int intervals = 64;
  lowest_ = infinity;
  highest_ = -infinity;
  double least = infinity;
  const auto found = [&](double well, double squares) {
    lowest_ = std::min(lowest_, well);
    highest_ = std::max(highest_, well);
    if (squares < least) {
      least = squares;
      peak_ = well;
    }
  };
  double before = sum_of_squares(low).slope;
  if (before >= 0) found(low == high - far ? -infinity : low, sum_of_squares(low).value);
  for (int i = 1; i <= intervals; ++i) {
    const double x = std::min(low + (high - low) * i / intervals, limit_);
    const double slope = sum_of_squares(x).slope;
    if (before < 0 && (slope >= 0 || i == intervals)) {
      double a = low + (high - low) * (i - 1) / intervals, b = x;
      for (int halving = 0; halving < 60 && slope >= 0; ++halving) {
        const double middle = 0.5 * (a + b);
        (sum_of_squares(middle).slope < 0 ? a : b) = middle;
      }
      found(b, sum_of_squares(b).value);
    }
    before = slope;
  }
  information_ = 0;
  if (std::isinf(peak_)) return;
  for (const DepthFunction& curve : curves_)
    information_ += std::pow(curve.depth_and_slope(std::min(peak_, limit_)).slope, 2);
}

Inspected::Point Inspected::at(double log_k, double sigma) const {
  if (!(log_k <= limit_)) return {-infinity, 0, 0};
  if (observations_) {
    const Dual<2> u(log_k, 0);
    const auto mean = [&](std::size_t i) { return curves_[i].depth(u); };
    const Dual<2> sum = observations_->log_likelihood(mean, Dual<2>(sigma, 1));
    if (!std::isfinite(sum.a)) return {-infinity, 0, 0};
    return {sum.a, sum.v[0], sum.v[1]};
  }
  const HermiteTable::Point squares =
      squares_.covers(log_k) ? squares_(log_k) : sum_of_squares(log_k);
  // One factor after the other: the square of a small sigma would underflow to 0.
  const double inverse = 1 / sigma;
  const double value = -0.5 * (squares.value * inverse) * inverse;
  return {value, -0.5 * (squares.slope * inverse) * inverse, -2 * value * inverse};
}

RateShape Inspected::shape(double sigma) const {
  RateShape shape{lowest_, highest_, peak_, (information_ / sigma) / sigma, 0, limit_, false};
  if (!observations_) {
    shape.largest = -0.5 * (least_squares_ / sigma) / sigma;
    shape.one_peak = lowest_ == highest_;
    return shape;
  }
  shape.lowest = infinity;
  shape.highest = -infinity;
  for (std::size_t i = 0; i < size(); ++i) {
    // The peak lies within a few sigma^2/y of y; its excess over the density at y is zeta^2/8 if
    // sigma is large, within 1.
    const double y = depths_[i], wide = 1 + 3 * std::min(1.0, (sigma / y) * (sigma / y));
    const double top = std::max(y, std::sqrt(sigma) * std::sqrt(y));
    shape.lowest = std::min(shape.lowest, log_k_of(duties_[i], y / wide, limit_));
    shape.highest = std::max(shape.highest, log_k_of(duties_[i], top * wide, limit_));
    const LognormalByMoments<double> curve(y, sigma);
    shape.largest +=
        lognormal_log_density(std::log(y), y, sigma) + 1 + 0.125 * curve.zeta * curve.zeta;
  }
  return shape;
}

double Inspected::largest_below(double log_k, double sigma) const {
  if (!observations_) return at(log_k, sigma).value;
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double mean = curves_[i].depth(log_k);
    const double here =
        mean > 0 ? lognormal_log_density(std::log(depths_[i]), mean, sigma) : -infinity;
    sum += std::max(here, log_density_far_below(depths_[i], sigma));
  }
  return sum;
}

std::vector<double> Inspected::pointwise(double log_k, double sigma) const {
  if (!(log_k <= limit_)) return std::vector<double>(size(), -infinity);
  const auto mean = [&](std::size_t i) { return curves_[i].depth(log_k); };
  return Observations(family_, depths_).pointwise(mean, sigma);
}

}  // namespace wearwell::bearing
