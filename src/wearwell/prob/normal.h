#pragma once

#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell {

struct Normal {
  double mean;
  double sd;  ///< > 0
};

template <class T>
T log_kernel(const Normal& law, const T& x) {
  const T z = (x - law.mean) / law.sd;
  return -0.5 * z * z;
}

/// log of the normal density of `x` with mean `mean` and standard deviation exp(log_sd) = 1 /
/// inverse_sd: the logarithm and the division are shared by all observations of one likelihood.
template <class T>
T normal_log_density(double x, const T& mean, const T& inverse_sd, const T& log_sd) {
  const T z = (x - mean) * inverse_sd;
  return -0.5 * z * z - log_sd - half_log_two_pi;
}

}  // namespace wearwell
