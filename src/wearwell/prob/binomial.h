#pragma once

#include "wearwell/prob/family.h"
#include "wearwell/prob/log_factorial.h"

namespace wearwell::families {

struct Binomial : OnLine {
  static constexpr bool counted = true;
  static constexpr std::string_view name = "binomial";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"probability", probability}});

  template <class T>
  static T log_density(double y, const T* s, double trials) {
    const double ways = log_factorial(trials) - log_factorial(y) - log_factorial(trials - y);
    const double p = scalar(s[0]);
    if ((p == 0 && y > 0) || (p == 1 && y < trials)) return T(-infinity);
    T sum(ways);
    if (y > 0) sum = sum + y * log(s[0]);
    if (y < trials) sum = sum + (trials - y) * log1p(-s[0]);
    return sum;
  }
  static double mean(const double* s) { return s[0]; }
};

}  // namespace wearwell::families
