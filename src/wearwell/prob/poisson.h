#pragma once

#include "wearwell/prob/family.h"
#include "wearwell/prob/log_factorial.h"

namespace wearwell::families {

struct Poisson : OnLine {
  static constexpr bool counted = true;
  static constexpr std::string_view name = "poisson";
  static constexpr auto family_parameters = std::to_array<ParameterForm>({{"mean", scale}});

  static bool allows(double mean) { return mean >= 0 && std::isfinite(mean); }
  template <class T>
  static T log_density(double y, const T* s, double /*trials*/) {
    if (scalar(s[0]) == 0) return y == 0 ? T(-s[0]) : T(-infinity);
    return y * log(s[0]) - s[0] - log_factorial(y);
  }
  static double mean(const double* s) { return s[0]; }
};

}  // namespace wearwell::families
