#pragma once

#include <boost/math/distributions/complement.hpp>

namespace wearwell::families {

/// P(X <= x), P(X > x) and their inverses for one of Boost's distributions, with location and scale
/// applied here, because SI values as small as 1e-13 would fail Boost's argument checks or
/// underflow.
template <class QuantityDistribution>
struct Tails {
  QuantityDistribution distribution;
  double location = 0;
  double scale = 1;

  double below(double x) const {
    return at(x, 0, 1, [&](double z) { return cdf(distribution, z); });
  }
  double above(double x) const {
    return at(x, 1, 0, [&](double z) { return cdf(complement(distribution, z)); });
  }
  double from_below(double p) const { return location + scale * quantile(distribution, p); }
  double from_above(double q) const {
    return location + scale * quantile(complement(distribution, q));
  }

 private:
  template <class F>
  double at(double x, double at_lowest, double at_highest, const F& f) const {
    const auto [lowest, highest] = support(distribution);
    const double z = (x - location) / scale;
    if (z <= lowest) return at_lowest;
    if (z >= highest) return at_highest;
    return f(z);
  }
};

template <class QuantityDistribution>
Tails(QuantityDistribution, double, double) -> Tails<QuantityDistribution>;

}  // namespace wearwell::families
