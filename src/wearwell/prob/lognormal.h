#pragma once

#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell {

/// log x is normal with mean `eta` and standard deviation `zeta` (An et al. 2011, eq. 8).
struct Lognormal {
  double eta;
  double zeta;  ///< > 0
};

/// The lognormal law whose quantity itself has mean `mean` > 0 and standard deviation `sd` > 0:
/// zeta^2 = log(1 + sd^2/mean^2), eta = log mean - zeta^2/2. (Eq. 8 of the paper prints the last
/// sign as +, which does not reproduce its own tables.)
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

template <class T>
T log_kernel(const Lognormal& law, const T& x) {
  using std::log;
  const T log_x = log(x);
  const T z = (log_x - law.eta) / law.zeta;
  return -0.5 * z * z - log_x;
}

/// log of the density at x = exp(log_x) of the lognormal law with the given mean and standard
/// deviation.
template <class T>
T lognormal_log_density(double log_x, const T& mean, const T& sd) {
  using std::log;
  const LognormalByMoments<T> law(mean, sd);
  const T z = (log_x - law.eta) / law.zeta;
  return -0.5 * z * z - log(law.zeta) - half_log_two_pi - log_x;
}

}  // namespace wearwell
