#pragma once

#include <cmath>

namespace wearwell {

/// Density proportional to x^(alpha-1) (1-x)^(beta-1) on 0 < x < 1.
struct Beta {
  double alpha;  ///< > 0
  double beta;   ///< > 0
};

template <class T>
T log_kernel(const Beta& law, const T& x) {
  using std::log;
  using std::log1p;
  return (law.alpha - 1) * log(x) + (law.beta - 1) * log1p(-x);
}

}  // namespace wearwell
