#pragma once

#include "wearwell/prob/family.h"

namespace wearwell::families {

/// P(Y > y) = exp(-(y/scale)^shape): the logarithm has the smallest extreme value distribution.
struct Weibull : OnPositive {
  static constexpr std::string_view name = "weibull";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"scale", scale}, {"shape", number}});
  static constexpr StandardDistribution standard = StandardDistribution::smallest_extreme_value;
  static constexpr Paper paper = {"Weibull", StandardDistribution::smallest_extreme_value};

  template <class U, class T>
  static auto z(const U& log_y, const T* s) {
    return (log_y - log(s[0])) * s[1];
  }
  template <class U, class T>
  static auto log_rate(const U& log_y, const T* s) {
    return log(s[1]) - log_y;
  }
  static double inverse(double z, const double* s) { return s[0] * std::exp(z / s[1]); }
  static double mean(const double* s) { return s[0] * std::tgamma(1 + 1 / s[1]); }

  static double log_of_first(double scale) { return std::log(scale); }
  static double log_of_second(double shape) { return std::log(shape); }
  template <bool sloped>
  static Row row(double log_y, const double* s, const double* log_s) {
    const double off = log_y - log_s[0], z = s[1] * off, e = std::exp(z);
    Row row{z - e + log_s[1] - log_y, {}};
    if constexpr (sloped) {
      row.slope[0] = (e - 1) * s[1] / s[0];
      row.slope[1] = (1 - e) * off + 1 / s[1];
    }
    return row;
  }
};

}  // namespace wearwell::families
