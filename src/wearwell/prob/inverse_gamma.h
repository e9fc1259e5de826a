#pragma once

#include <cmath>

namespace wearwell {

/// 1/x has the gamma law: density proportional to x^(-shape-1) exp(-scale/x) on x > 0.
struct InverseGamma {
  double shape;  ///< > 0
  double scale;  ///< > 0
};

template <class T>
T log_kernel(const InverseGamma& law, const T& x) {
  using std::log;
  return -(law.shape + 1) * log(x) - law.scale / x;
}

}  // namespace wearwell
