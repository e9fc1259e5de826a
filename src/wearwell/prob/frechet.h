#pragma once

#include "wearwell/prob/family.h"

namespace wearwell::families {

/// P(Y <= y) = exp(-(y/scale)^-shape): the logarithm has the largest extreme value distribution
/// (Meeker and Escobar 1998, sec. 4.9).
struct Frechet : OnPositive {
  static constexpr std::string_view name = "frechet";
  static constexpr std::string_view title = "Frechet";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"scale", scale}, {"shape", number}});
  static constexpr StandardDistribution standard = StandardDistribution::largest_extreme_value;

  template <class U, class T>
  static auto z(const U& log_y, const T* s) {
    return (log_y - log(s[0])) * s[1];
  }
  template <class U, class T>
  static auto log_rate(const U& log_y, const T* s) {
    return log(s[1]) - log_y;
  }
  static double inverse(double z, const double* s) { return s[0] * std::exp(z / s[1]); }
  static double mean(const double* s) {
    return s[1] > 1 ? s[0] * std::tgamma(1 - 1 / s[1]) : inverse(quantile(standard, 0.5), s);
  }
};

}  // namespace wearwell::families
