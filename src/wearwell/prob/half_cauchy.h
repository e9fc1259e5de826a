#pragma once

#include "wearwell/prob/student_t.h"

namespace wearwell::families {

/// The positive half of Student's t about 0 with one degree of freedom; the scale is the median.
struct HalfCauchy : OnPositive {
  static constexpr bool prior_only = true;
  static constexpr std::string_view name = "half-cauchy";
  static constexpr std::string_view title = "half-Cauchy";
  static constexpr auto family_parameters = std::to_array<ParameterForm>({{"scale", scale}});

  static std::array<double, most_response_parameters> prepared(const double* s) {
    return {1, 0, s[0]};
  }
  template <class X>
  static X log_kernel(const X& x, const double* c) {
    return StudentT::log_kernel(x, c);
  }
  static double log_integral(const double* c) { return StudentT::log_integral(c); }
  static auto tails(const double* c) { return StudentT::tails(c); }
};

}  // namespace wearwell::families
