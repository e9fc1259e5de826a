#pragma once

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/math/root.h"
#include "wearwell/prob/family.h"
#include "wearwell/prob/gamma_tail.h"
#include "wearwell/prob/tails.h"

namespace wearwell::families {

namespace student {

// log P(T > t), t >= 0, by the series of the incomplete beta function, where its value underflows.
inline double log_far_tail(double df, double t) {
  const double x = df / (df + t * t), a = 0.5 * df;
  double term = 1, sum = 1;
  for (int n = 0; n < 100'000 && term > 1e-17 * sum; ++n) {
    term *= x * (a + 0.5 + n) / (a + 1 + n);
    sum += term;
  }
  return std::log(0.5) + a * std::log(x) + 0.5 * std::log1p(-x) + std::log(sum) - std::log(a) -
         (boost::math::lgamma(a, Quiet()) + boost::math::lgamma(0.5, Quiet()) -
          boost::math::lgamma(a + 0.5, Quiet()));
}

inline double log_survival(double df, double t) {
  if (t < 0) return std::log1p(-std::exp(log_survival(df, -t)));
  const double x = df / (df + t * t);
  const double p = t * t < df ? 0.5 - 0.5 * boost::math::ibeta(0.5, 0.5 * df, 1 - x, Quiet())
                              : 0.5 * boost::math::ibeta(0.5 * df, 0.5, x, Quiet());
  return p > 1e-280 ? std::log(p) : log_far_tail(df, t);
}

template <class T>
T log_density(const T& df, const T& t) {
  const T half = 0.5 * df;
  return log_gamma(T(half + 0.5)) - log_gamma(half) - 0.5 * log(M_PI * df) -
         (half + 0.5) * log1p(t * t / df);
}

template <int N>
Dual<N> log_survival(const Dual<N>& df, const Dual<N>& t) {
  const double value = log_survival(df.a, t.a);
  // The derivative by the degrees of freedom has no closed form: central difference, accurate to
  // 1e-8.
  const double step = 1e-4 * df.a;
  const double by_df =
      df.v.isZero()
          ? 0
          : (log_survival(df.a + step, t.a) - log_survival(df.a - step, t.a)) / (2 * step);
  const double by_t = -std::exp(log_density(df.a, t.a) - value);
  return Dual<N>(value, by_df * df.v + by_t * t.v);
}

}  // namespace student

/// Student's t with `df` degrees of freedom; df 1 is the Cauchy distribution.
struct StudentT : OnLine {
  static constexpr std::string_view name = "student-t";
  static constexpr std::string_view title = "Student t";
  static constexpr auto family_parameters = std::to_array<ParameterForm>(
      {{"df", number, false, "{} degrees of freedom"}, {"location", location}, {"scale", scale}});

  template <class Y, class T>
  static auto log_density(const Y& y, const T* s) {
    using R = Result<Y, T>;
    return student::log_density(R(s[0]), R((y - s[1]) / s[2])) - log(s[2]);
  }
  template <class Y, class T>
  static auto log_survival(const Y& y, const T* s) {
    using R = Result<Y, T>;
    return student::log_survival(R(s[0]), R((y - s[1]) / s[2]));
  }
  template <class Y, class T>
  static auto log_cdf(const Y& y, const T* s) {
    using R = Result<Y, T>;
    return student::log_survival(R(s[0]), R(-(y - s[1]) / s[2]));
  }
  static double quantile(double p, const double* s) {
    return solve_increasing([&](double y) { return std::exp(log_cdf(y, s)) - p; }, s[1], s[2],
                            {.relative = 1e-12});
  }
  static double mean(const double* s) { return s[1]; }

  template <class X>
  static X log_kernel(const X& x, const double* s) {
    const X z = (x - s[1]) / s[2];
    return -0.5 * (s[0] + 1) * log1p(z * z / s[0]);
  }
  static double log_integral(const double* s) {
    return std::log(boost::math::beta(0.5, 0.5 * s[0], Quiet())) + 0.5 * std::log(s[0]) +
           std::log(s[2]);
  }
  static auto tails(const double* s) {
    return Tails{boost::math::students_t_distribution<double, Quiet>(s[0]), s[1], s[2]};
  }
};

}  // namespace wearwell::families
