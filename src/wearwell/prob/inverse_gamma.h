#pragma once

#include <boost/math/distributions/inverse_gamma.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/prob/family.h"
#include "wearwell/prob/tails.h"

namespace wearwell::families {

/// 1/x has the gamma distribution: density proportional to x^(-shape-1) exp(-scale/x).
struct InverseGamma : OnPositive {
  static constexpr bool prior_only = true;
  static constexpr std::string_view name = "inverse-gamma";
  static constexpr std::string_view title = "inverse gamma";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"shape", number}, {"scale", scale}});

  template <class X>
  static X log_kernel(const X& x, const double* s) {
    return -(s[0] + 1) * log(x) - s[1] / x;
  }
  static double log_integral(const double* s) {
    return boost::math::lgamma(s[0], Quiet()) - s[0] * std::log(s[1]);
  }
  static auto tails(const double* s) {
    return Tails{boost::math::inverse_gamma_distribution<double, Quiet>(s[0], 1), 0, s[1]};
  }
};

}  // namespace wearwell::families
