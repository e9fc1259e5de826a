#pragma once

#include <boost/math/special_functions/gamma.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/prob/family.h"

namespace wearwell::families {

struct Binomial : OnLine {
  static constexpr bool counted = true;
  static constexpr std::string_view name = "binomial";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"probability", probability}});

  template <class T>
  static T log_density(double y, const T* s, double trials) {
    const double ways = boost::math::lgamma(trials + 1, Quiet()) -
                        boost::math::lgamma(y + 1, Quiet()) -
                        boost::math::lgamma(trials - y + 1, Quiet());
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
