#pragma once

#include <cmath>

namespace wearwell {

/// Density proportional to x^(shape-1) exp(-x/scale) on x > 0; shape 1 is the exponential law of
/// mean `scale`.
struct Gamma {
  double shape;  ///< > 0
  double scale;  ///< > 0
};

template <class T>
T log_kernel(const Gamma& law, const T& x) {
  using std::log;
  if (law.shape == 1) return -x / law.scale;
  return (law.shape - 1) * log(x) - x / law.scale;
}

}  // namespace wearwell
