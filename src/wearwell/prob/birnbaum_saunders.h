#pragma once

#include "wearwell/prob/family.h"

namespace wearwell::families {

/// The fatigue-life distribution of Birnbaum and Saunders (1969): (sqrt(y/scale) -
/// sqrt(scale/y))/shape is standard normal; the scale is the median (Johnson, Kotz and Balakrishnan
/// 1995, ch. 33).
struct BirnbaumSaunders : OnPositive {
  static constexpr std::string_view name = "birnbaum-saunders";
  static constexpr std::string_view title = "Birnbaum-Saunders";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"scale", scale}, {"shape", number}});
  static constexpr StandardDistribution standard = StandardDistribution::normal;

  template <class U, class T>
  static auto z(const U& log_y, const T* s) {
    return 2.0 * sinh(half_log_ratio(log_y, s)) / s[1];
  }
  template <class U, class T>
  static auto log_rate(const U& log_y, const T* s) {
    return log(cosh(half_log_ratio(log_y, s))) - log(s[1]) - log_y;
  }
  static double inverse(double z, const double* s) {
    return s[0] * std::exp(2 * std::asinh(0.5 * s[1] * z));
  }
  static double mean(const double* s) { return s[0] * (1 + 0.5 * s[1] * s[1]); }

 private:
  template <class U, class T>
  static auto half_log_ratio(const U& log_y, const T* s) {
    return 0.5 * (log_y - log(s[0]));
  }
};

}  // namespace wearwell::families
