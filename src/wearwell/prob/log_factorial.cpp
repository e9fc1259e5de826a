#include "wearwell/prob/log_factorial.h"

#include <array>
#include <boost/math/special_functions/gamma.hpp>

#include "wearwell/math/boost_policy.h"

namespace wearwell {

double log_factorial(double k) {
  static const auto table = [] {
    std::array<double, 1024> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = boost::math::lgamma(static_cast<double>(i) + 1, Quiet());
    return values;
  }();
  if (k >= 0 && k < static_cast<double>(table.size())) return table[static_cast<std::size_t>(k)];
  return boost::math::lgamma(k + 1, Quiet());
}

}  // namespace wearwell
