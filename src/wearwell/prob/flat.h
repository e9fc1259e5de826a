#pragma once

#include "wearwell/prob/family.h"

namespace wearwell::families {

/// A constant density for no prior knowledge. Improper unless both ends are bounded; the bounds are
/// then only a truncation.
struct Flat : OnLine {
  static constexpr bool prior_only = true;
  static constexpr std::string_view name = "flat";
  static constexpr std::string_view title = "flat (no prior knowledge)";
  static constexpr std::array<ParameterForm, 0> family_parameters = {};

  template <class X>
  static X log_kernel(const X&, const double*) {
    return X(0);
  }
  /// The log integral of the kernel; infinite if it diverges.
  static double log_integral_between(double lower, double upper) { return std::log(upper - lower); }
  static double quantile_between(double p, double lower, double upper) {
    return lower + p * (upper - lower);
  }
};

/// Prior knowledge that the quantity lies between two bounds.
struct Uniform : Flat {
  static constexpr std::string_view name = "uniform";
  static constexpr std::string_view title = {};
};

}  // namespace wearwell::families
