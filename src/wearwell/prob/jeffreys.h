#pragma once

#include "wearwell/prob/family.h"

namespace wearwell::families {

/// Jeffreys' prior for a scale: density proportional to 1/x on x > 0. Improper unless bounded away
/// from 0 and infinity.
struct Jeffreys : OnPositive {
  static constexpr bool prior_only = true;
  static constexpr std::string_view name = "jeffreys";
  static constexpr std::string_view title = "1/x (unknown order of magnitude)";
  static constexpr std::array<ParameterForm, 0> family_parameters = {};

  template <class X>
  static X log_kernel(const X& x, const double*) {
    return -log(x);
  }
  static double log_integral_between(double lower, double upper) {
    return lower > 0 ? std::log(std::log(upper / lower)) : infinity;
  }
  static double quantile_between(double p, double lower, double upper) {
    return lower * std::pow(upper / lower, p);
  }
};

}  // namespace wearwell::families
