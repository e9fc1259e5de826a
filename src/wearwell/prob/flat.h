#pragma once

#include "wearwell/prob/family.h"

namespace wearwell::families {

/// No knowledge: constant. Improper unless both ends are bounded, and then only a cut.
struct Flat : OnLine {
  static constexpr bool prior_only = true;
  static constexpr std::string_view name = "flat";
  static constexpr std::string_view title = "flat: nothing is known";
  static constexpr std::array<ParameterForm, 0> slots = {};

  template <class X>
  static X log_kernel(const X&, const double*) {
    return X(0);
  }
  /// Of the kernel; infinite where it has none.
  static double log_integral_between(double lower, double upper) { return std::log(upper - lower); }
  static double quantile_between(double p, double lower, double upper) {
    return lower + p * (upper - lower);
  }
};

/// Knowledge that the quantity lies between two bounds, and no more.
struct Uniform : Flat {
  static constexpr std::string_view name = "uniform";
  static constexpr std::string_view title = {};
};

}  // namespace wearwell::families
