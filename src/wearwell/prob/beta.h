#pragma once

#include <boost/math/distributions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/prob/family.h"
#include "wearwell/prob/tails.h"

namespace wearwell::families {

/// Density proportional to x^(alpha-1) (1-x)^(beta-1) on 0 < x < 1.
struct Beta : OnPositive {
  static constexpr bool prior_only = true;
  static constexpr std::string_view name = "beta";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"alpha", number}, {"beta", number}});
  static constexpr double upper = 1;

  template <class X>
  static X log_kernel(const X& x, const double* s) {
    return (s[0] - 1) * log(x) + (s[1] - 1) * log1p(-x);
  }
  // From log gammas, because the beta function underflows from alpha = beta = 515.
  static double log_integral(const double* s) {
    return boost::math::lgamma(s[0], Quiet()) + boost::math::lgamma(s[1], Quiet()) -
           boost::math::lgamma(s[0] + s[1], Quiet());
  }
  static auto tails(const double* s) {
    return Tails{boost::math::beta_distribution<double, Quiet>(s[0], s[1]), 0, 1};
  }
};

}  // namespace wearwell::families
