#pragma once

#include "wearwell/prob/family.h"

namespace wearwell::families {

/// The distribution of the logarithm of a Weibull variable.
struct SmallestExtremeValue : OnLine {
  static constexpr std::string_view name = "smallest-extreme-value";
  static constexpr std::string_view title = "smallest extreme value";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"location", location}, {"scale", scale}});
  static constexpr StandardDistribution standard = StandardDistribution::smallest_extreme_value;
  static constexpr Paper paper = {"smallest-extreme-value",
                                  StandardDistribution::smallest_extreme_value};

  template <class Y, class T>
  static auto z(const Y& y, const T* s) {
    return (y - s[0]) / s[1];
  }
  template <class Y, class T>
  static auto log_rate(const Y&, const T* s) {
    return -log(s[1]);
  }
  static double inverse(double z, const double* s) { return s[0] + s[1] * z; }
  static double mean(const double* s) {
    return s[0] - s[1] * 0.57721566490153286;
  }  // Euler's constant
};

}  // namespace wearwell::families
