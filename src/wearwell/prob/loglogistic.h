#pragma once

#include "wearwell/prob/family.h"

namespace wearwell::families {

/// The logarithm has the logistic distribution; the scale is the median.
struct Loglogistic : OnPositive {
  static constexpr std::string_view name = "loglogistic";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"scale", scale}, {"shape", number}});
  static constexpr StandardDistribution standard = StandardDistribution::logistic;
  static constexpr Paper paper = {"loglogistic", StandardDistribution::logistic};

  template <class U, class T>
  static auto z(const U& log_y, const T* s) {
    return (log_y - log(s[0])) * s[1];
  }
  template <class U, class T>
  static auto log_rate(const U& log_y, const T* s) {
    return log(s[1]) - log_y;
  }
  static double inverse(double z, const double* s) { return s[0] * std::exp(z / s[1]); }
  static double mean(const double* s) { return s[0]; }  // the median
};

}  // namespace wearwell::families
