#pragma once

#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell {

/// log of the normal density of `x` with mean `mean` and standard deviation exp(log_sd) = 1 /
/// inverse_sd: all observations of one likelihood share the logarithm and the division.
template <class T>
T normal_log_density(double x, const T& mean, const T& inverse_sd, const T& log_sd) {
  const T z = (x - mean) * inverse_sd;
  return -0.5 * z * z - log_sd - half_log_two_pi;
}

/// The lognormal distribution with mean `mean` > 0 and standard deviation `sd` > 0 of the quantity:
/// zeta^2 = log(1 + sd^2/mean^2), eta = log mean - zeta^2/2 are the parameters of the normal
/// distribution of the logarithm. (An et al. 2011, eq. 8, prints the last sign as +, which does not
/// reproduce its own tables.)
template <class T>
struct LognormalByMoments {
  T eta;
  T zeta;

  LognormalByMoments(const T& mean, const T& sd) {
    using std::log;
    using std::log1p;
    using std::sqrt;
    const T ratio = sd / mean;
    const T variance = log1p(ratio * ratio);
    zeta = sqrt(variance);
    eta = log(mean) - 0.5 * variance;
  }
};

/// log of the density at x = exp(log_x) of the lognormal distribution with this mean and standard
/// deviation.
template <class T>
T lognormal_log_density(double log_x, const T& mean, const T& sd) {
  using std::log;
  const LognormalByMoments<T> distribution(mean, sd);
  const T z = (log_x - distribution.eta) / distribution.zeta;
  return -0.5 * z * z - log(distribution.zeta) - half_log_two_pi - log_x;
}

}  // namespace wearwell
