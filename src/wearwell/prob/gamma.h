#pragma once

#include <boost/math/distributions/gamma.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/prob/family.h"
#include "wearwell/prob/gamma_tail.h"
#include "wearwell/prob/quantile_root.h"
#include "wearwell/prob/tails.h"

namespace wearwell::families {

/// Density proportional to y^(shape-1) exp(-y/scale).
struct Gamma : OnPositive {
  static constexpr std::string_view name = "gamma";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"shape", number}, {"scale", scale}});

  template <class Y, class T>
  static auto log_density(const Y& y, const T* s) {
    using R = Result<Y, T>;
    return detail::log_gamma_kernel(R(s[0]), R(y / s[1])) - log(y);
  }
  template <class Y, class T>
  static auto log_survival(const Y& y, const T* s) {
    using R = Result<Y, T>;
    return log_gamma_upper(R(s[0]), R(y / s[1]));
  }
  template <class Y, class T>
  static auto log_cdf(const Y& y, const T* s) {
    using R = Result<Y, T>;
    return log_gamma_lower(R(s[0]), R(y / s[1]));
  }
  static double quantile(double p, const double* s) {
    return positive_quantile<Gamma>(p, s, mean(s));
  }
  static double mean(const double* s) { return s[0] * s[1]; }

  template <class X>
  static X log_kernel(const X& x, const double* s) {
    if (s[0] == 1) return -x / s[1];
    return (s[0] - 1) * log(x) - x / s[1];
  }
  static double log_integral(const double* s) {
    return boost::math::lgamma(s[0], Quiet()) + s[0] * std::log(s[1]);
  }
  static auto tails(const double* s) {
    return Tails{boost::math::gamma_distribution<double, Quiet>(s[0], 1), 0, s[1]};
  }
};

}  // namespace wearwell::families
