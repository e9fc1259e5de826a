#pragma once

#include <cmath>

#include "wearwell/base/rng.h"

namespace wearwell {

/// A gamma variate of rate 1, by the method of Marsaglia and Tsang (2000).
inline double gamma_variate(double shape, Rng& rng) {
  if (shape < 1) return gamma_variate(shape + 1, rng) * std::pow(rng.uniform(), 1 / shape);
  const double d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
  for (;;) {
    const double x = rng.normal(), root = 1 + c * x;
    if (!(root > 0)) continue;
    const double v = root * root * root;
    if (std::log(rng.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

}  // namespace wearwell
