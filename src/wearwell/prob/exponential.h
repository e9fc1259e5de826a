#pragma once

#include "wearwell/prob/gamma.h"

namespace wearwell::families {

/// The Weibull distribution of shape 1, and the gamma distribution of shape 1.
struct Exponential : OnPositive {
  static constexpr std::string_view name = "exponential";
  static constexpr auto family_parameters = std::to_array<ParameterForm>({{"mean", scale}});
  static constexpr StandardDistribution standard = StandardDistribution::smallest_extreme_value;
  static constexpr Paper paper = {"Weibull", StandardDistribution::smallest_extreme_value};

  template <class U, class T>
  static auto z(const U& log_y, const T* s) {
    return log_y - log(s[0]);
  }
  template <class U, class T>
  static auto log_rate(const U& log_y, const T*) {
    return -log_y;
  }
  static double inverse(double z, const double* s) { return s[0] * std::exp(z); }
  static double mean(const double* s) { return s[0]; }

  static std::array<double, most_response_parameters> prepared(const double* s) {
    return {1, s[0]};
  }
  template <class X>
  static X log_kernel(const X& x, const double* c) {
    return Gamma::log_kernel(x, c);
  }
  static double log_integral(const double* c) { return Gamma::log_integral(c); }
  static auto tails(const double* c) { return Gamma::tails(c); }
};

}  // namespace wearwell::families
