#pragma once

#include <cmath>

#include "wearwell/math/dual.h"

namespace wearwell {

/// log(1 - p) of log p < 0.
template <class T>
T log_rest(const T& log_p) {
  const double p = std::exp(scalar(log_p));
  return chained(log_p,
                 scalar(log_p) > -0.7 ? std::log(-std::expm1(scalar(log_p))) : std::log1p(-p),
                 -p / -std::expm1(scalar(log_p)));
}

/// log(e^a - e^b) for a > b.
template <class T>
T log_difference(const T& a, const T& b) {
  return a + log_rest(T(b - a));
}

}  // namespace wearwell
