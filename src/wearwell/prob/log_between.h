#pragma once

#include "wearwell/math/quadrature.h"
#include "wearwell/prob/family_functions.h"
#include "wearwell/prob/log_sums.h"

namespace wearwell::families {

/// log P(a < Y <= b) for a narrow interval inside the support, by Gauss-Legendre to avoid
/// cancellation.
template <class F, class T>
T log_narrow(double a, double b, const T* s) {
  static const GaussLegendre rule = gauss_legendre(12);
  const double half = 0.5 * (b - a);
  const T highest = log_density<F>(a + half, s);
  T sum(0);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double y = a + half + half * rule.node[i];
    sum = sum + rule.weight[i] * exp(log_density<F>(y, s) - highest);
  }
  return highest + log(half * sum);
}

/// log P(a < Y <= b); a and b may be at or beyond the ends of the support.
template <class F, class T>
T log_between(double a, double b, const T* s) {
  const double end = lower_end<F>(s);
  if (!(b > end && b > a)) return T(-infinity);
  if (!(a > end)) return b == infinity ? T(0) : log_cdf<F>(b, s);
  if (b == infinity) return log_survival<F>(a, s);
  if constexpr (OnStandardAxis<Base<F>>) {
    constexpr double thin = 0.01;
    const T low = standard_place<F>(a, s), high = standard_place<F>(b, s);
    if (scalar(high) - scalar(low) < thin) return log_narrow<F>(a, b, s);
    return wearwell::log_between(Base<F>::standard, low, high);
  } else {
    constexpr double narrow = 0.1;
    const T below_b = log_cdf<F>(b, s), below_a = log_cdf<F>(a, s);
    const bool low = scalar(below_b) < std::log(0.5);
    const T large = low ? below_b : log_survival<F>(a, s);
    const T small = low ? below_a : log_survival<F>(b, s);
    if (scalar(large) - scalar(small) < narrow) return log_narrow<F>(a, b, s);
    return log_difference(large, small);
  }
}

}  // namespace wearwell::families
