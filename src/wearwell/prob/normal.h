#pragma once

#include <boost/math/distributions/normal.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/prob/family.h"
#include "wearwell/prob/tails.h"

namespace wearwell::families {

struct Normal : OnLine {
  static constexpr std::string_view name = "normal";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"mean", location}, {"sd", scale}});
  static constexpr StandardDistribution standard = StandardDistribution::normal;
  static constexpr Paper paper = {"normal", StandardDistribution::normal};
  static constexpr const char* c_density =
      "    const double z = (y - a) / b;\n"
      "    value = b > 0 ? -0.5 * z * z - (log(b) + 0.91893853320467274178) : -INFINITY;\n";

  template <class Y, class T>
  static auto z(const Y& y, const T* s) {
    return (y - s[0]) / s[1];
  }
  template <class Y, class T>
  static auto log_rate(const Y&, const T* s) {
    return -log(s[1]);
  }
  static double inverse(double z, const double* s) { return s[0] + s[1] * z; }
  static double mean(const double* s) { return s[0]; }

  static double log_of_first(double) { return 0; }
  static double log_of_second(double sd) { return std::log(sd); }
  template <bool sloped>
  static Row row(double y, const double* s, const double* log_s) {
    return normal_row(y, s[0], s[1], log_s[1]);
  }

  template <class X>
  static X log_kernel(const X& x, const double* s) {
    const X z = (x - s[0]) / s[1];
    return -0.5 * z * z;
  }
  static double log_integral(const double* s) { return 0.5 * log_two_pi + std::log(s[1]); }
  static auto tails(const double* s) {
    return Tails{boost::math::normal_distribution<double, Quiet>(), s[0], s[1]};
  }
};

}  // namespace wearwell::families
