#pragma once

#include "wearwell/prob/normal.h"

namespace wearwell::families {

/// The positive half of the normal distribution about 0.
struct HalfNormal : OnPositive {
  static constexpr bool prior_only = true;
  static constexpr std::string_view name = "half-normal";
  static constexpr auto family_parameters = std::to_array<ParameterForm>({{"scale", scale}});

  template <class X>
  static X log_kernel(const X& x, const double* s) {
    const X z = x / s[0];
    return -0.5 * z * z;
  }
  static double log_integral(const double* s) { return 0.5 * log_two_pi + std::log(s[0]); }
  static auto tails(const double* s) {
    return Tails{boost::math::normal_distribution<double, Quiet>(), 0, s[0]};
  }
};

}  // namespace wearwell::families
