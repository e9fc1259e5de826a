#pragma once

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <type_traits>

#include "wearwell/math/boost_policy.h"
#include "wearwell/math/dual.h"
#include "wearwell/prob/log_sums.h"

namespace wearwell {

/// log Gamma(x), x > 0, for a formula's scalar.
template <class T>
T log_gamma(const T& x) {
  const double value = boost::math::lgamma(scalar(x), Quiet());
  if constexpr (std::is_same_v<T, double>) return value;
  return chained(x, value, digamma<Quiet>(scalar(x)));
}

namespace detail {

inline bool settled(double change, double sum) {
  return std::abs(change) <= 1e-17 * std::abs(sum);
}
template <int N>
bool settled(const Dual<N>& change, const Dual<N>& sum) {
  return settled(change.a, sum.a) &&
         change.v.cwiseAbs().maxCoeff() <= 1e-15 * (std::abs(sum.a) + sum.v.cwiseAbs().maxCoeff());
}

inline constexpr int most_gamma_terms = 100'000;

// log of x^a e^-x / Gamma(a).
template <class T>
T log_gamma_kernel(const T& a, const T& x) {
  using std::log;
  return a * log(x) - x - log_gamma(a);
}

// log P(a, x) by its series, for x < a + 1 (Abramowitz and Stegun 6.5.29).
template <class T>
T log_lower_by_series(const T& a, const T& x, const T& log_kernel) {
  using std::log;
  T term = 1.0 / a, sum = term;
  for (int n = 1; n < most_gamma_terms; ++n) {
    term = term * x / (a + static_cast<double>(n));
    sum = sum + term;
    if (settled(term, sum)) break;
  }
  return log_kernel + log(sum);
}

// log Q(a, x) by its continued fraction, for x >= a + 1 (Abramowitz and Stegun 6.5.31, by Lentz's
// method).
template <class T>
T log_upper_by_fraction(const T& a, const T& x, const T& log_kernel) {
  using std::log;
  constexpr double tiny = 1e-300;
  T b = x + 1.0 - a, c = T(1 / tiny), d = 1.0 / b, h = d;
  for (int n = 1; n < most_gamma_terms; ++n) {
    const T numerator = static_cast<double>(-n) * (static_cast<double>(n) - a);
    b = b + 2.0;
    d = numerator * d + b;
    if (std::abs(scalar(d)) < tiny) d = T(tiny);
    c = b + numerator / c;
    if (std::abs(scalar(c)) < tiny) c = T(tiny);
    d = 1.0 / d;
    const T before = h;
    h = h * (d * c);
    if (settled(T(h - before), T(10.0 * h))) break;
  }
  return log_kernel + log(h);
}

}  // namespace detail

/// Logarithms of the regularized incomplete gamma functions P(a, x) and Q(a, x), a > 0, x > 0: each
/// is accurate even where it is tiny. `log_kernel` is log(x^a e^-x / Gamma(a)), for callers that
/// have it with more digits.
template <class T>
T log_gamma_lower(const T& a, const T& x, const T& log_kernel) {
  return scalar(x) < scalar(a) + 1 ? detail::log_lower_by_series(a, x, log_kernel)
                                   : log_rest(detail::log_upper_by_fraction(a, x, log_kernel));
}
template <class T>
T log_gamma_upper(const T& a, const T& x, const T& log_kernel) {
  return scalar(x) < scalar(a) + 1 ? log_rest(detail::log_lower_by_series(a, x, log_kernel))
                                   : detail::log_upper_by_fraction(a, x, log_kernel);
}
template <class T>
T log_gamma_lower(const T& a, const T& x) {
  return log_gamma_lower(a, x, detail::log_gamma_kernel(a, x));
}
template <class T>
T log_gamma_upper(const T& a, const T& x) {
  return log_gamma_upper(a, x, detail::log_gamma_kernel(a, x));
}

}  // namespace wearwell
