#pragma once

#include <boost/math/quadrature/tanh_sinh.hpp>

#include "wearwell/prob/log_sums.h"
#include "wearwell/prob/weibull.h"

namespace wearwell::families {

/// P(Y <= y) = (1 - exp(-(y/scale)^shape))^exponent (Mudholkar and Srivastava 1993): the maximum of
/// `exponent` Weibull lives if that is a whole number. Its hazard can have a bathtub shape.
struct ExponentiatedWeibull : OnPositive {
  static constexpr std::string_view name = "exponentiated-weibull";
  static constexpr std::string_view title = "exponentiated Weibull";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"scale", scale}, {"shape", number}, {"exponent", number}});
  static constexpr Paper paper = {"Weibull", StandardDistribution::smallest_extreme_value, false};

  template <class Y, class T>
  static auto log_density(const Y& y, const T* s) {
    const auto log_y = log(y);
    const auto z = Weibull::z(log_y, s);
    return log(s[2]) + (s[2] - 1.0) * wearwell::log_cdf(Weibull::standard, z) +
           wearwell::log_density(Weibull::standard, z) + Weibull::log_rate(log_y, s);
  }
  template <class Y, class T>
  static auto log_cdf(const Y& y, const T* s) {
    return s[2] * wearwell::log_cdf(Weibull::standard, Weibull::z(log(y), s));
  }
  template <class Y, class T>
  static auto log_survival(const Y& y, const T* s) {
    using R = Result<Y, T>;
    const R z = Weibull::z(log(y), s);
    // Where the Weibull survival S is below 1e-17, 1 - (1 - S)^exponent is 1 - exp(-exponent S).
    if (scalar(z) > 3.7) {
      const R log_rate = log(s[2]) + wearwell::log_survival(Weibull::standard, z);
      return scalar(log_rate) < -37 ? log_rate : R(log_rest(R(-exp(log_rate))));
    }
    return R(log_rest(R(s[2] * wearwell::log_cdf(Weibull::standard, z))));
  }
  static double quantile(double p, const double* s) { return quantile_at(std::log(p) / s[2], s); }
  static double mean(const double* s) {
    static thread_local boost::math::quadrature::tanh_sinh<double> rule;
    return rule.integrate(
        [&](double p,
            double to_end) {  // p from the nearer tail, so that its logarithm keeps its digits
          return quantile_at((to_end < 0 ? std::log(p) : std::log1p(-to_end)) / s[2], s);
        },
        0.0, 1.0);
  }

 private:
  // The Weibull quantile of exp(log_p).
  static double quantile_at(double log_p, const double* s) {
    const double z = log_p < -37 ? log_p : std::log(-log_rest(log_p));
    return Weibull::inverse(z, s);
  }
};

}  // namespace wearwell::families
