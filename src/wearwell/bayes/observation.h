#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "wearwell/prob/lognormal.h"
#include "wearwell/prob/normal.h"

namespace wearwell {

/// How a measurement scatters about its mean: normal, or lognormal with mean and standard deviation
/// of the quantity itself (An et al. 2011, eqs. 7 and 8).
enum class ObservationFamily { normal, lognormal };

/// Measurements of one quantity, all with the same standard deviation, in SI.
class Observations {
 public:
  /// `y` must be positive for the lognormal family.
  Observations(ObservationFamily family, std::vector<double> y)
      : family_(family), y_(std::move(y)) {
    if (family_ == ObservationFamily::lognormal) {
      for (double& value : y_) value = std::log(value);
    }
  }

  /// Sum of log densities where `mean(i)` is the mean of measurement i; -infinity where a lognormal
  /// mean is not positive.
  template <class T, class Mean>
  T log_likelihood(const Mean& mean, const T& sd) const {
    using std::log;
    T sum(0);
    if (family_ == ObservationFamily::normal) {
      const T inverse_sd = 1.0 / sd;
      const T log_sd = log(sd);
      for (std::size_t i = 0; i < y_.size(); ++i) {
        sum += normal_log_density(y_[i], mean(i), inverse_sd, log_sd);
      }
    } else {
      for (std::size_t i = 0; i < y_.size(); ++i) {
        const T mu = mean(i);
        if (!(mu > 0.0)) return T(-std::numeric_limits<double>::infinity());
        sum += lognormal_log_density(y_[i], mu, sd);
      }
    }
    return sum;
  }

 private:
  ObservationFamily family_;
  std::vector<double> y_;  // log y for the lognormal family
};

/// P(measurement <= y) where its mean and standard deviation are known.
inline double observation_cdf(ObservationFamily family, double y, double mean, double sd) {
  if (family == ObservationFamily::normal) {
    return 0.5 * std::erfc((mean - y) / (sd * std::sqrt(2.0)));
  }
  if (y <= 0) return 0;
  // A lognormal quantity vanishes with its mean: the median is mean^2/sqrt(mean^2 + sd^2).
  if (!(mean > 1e-150 * sd)) return 1;
  const LognormalByMoments<double> law(mean, sd);
  return 0.5 * std::erfc((law.eta - std::log(y)) / (law.zeta * std::sqrt(2.0)));
}

}  // namespace wearwell
