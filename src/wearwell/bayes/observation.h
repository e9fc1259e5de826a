#pragma once

#include <cmath>
#include <vector>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/math/constants.h"
#include "wearwell/prob/normal_density.h"

namespace wearwell {

/// Distribution of a measurement about its mean: normal, or lognormal with mean and standard
/// deviation of the quantity itself (An et al. 2011, eqs. 7 and 8).
enum class ObservationFamily { normal, lognormal };

/// The distribution of one measurement whose mean and standard deviation are known, ready for many
/// evaluations: normal in y, or in log y for the lognormal family. Numbers are in the unit of the
/// measurement, logarithms natural.
struct ObservationDistribution {
  double location;
  double scale;

  ObservationDistribution(ObservationFamily family, double mean, double sd)
      : location(mean), scale(sd) {
    if (family == ObservationFamily::lognormal) {
      // A lognormal quantity vanishes with its mean: the median is mean^2/sqrt(mean^2 + sd^2).
      if (!(mean > 1e-150 * sd)) {
        location = -infinity;
        return;
      }
      if (!std::isfinite(mean)) return;  // larger than any reading
      const LognormalByMoments<double> distribution(mean, sd);
      location = distribution.eta;
      scale = distribution.zeta;
    }
  }

  /// (t - location)/scale: the standardized residual, standard normal.
  double score(double t) const { return (t - location) / scale; }

  /// P(measurement <= y), where `t` is y, or log y for the lognormal family.
  double cdf(double t) const {
    const double z = (location - t) / (scale * std::sqrt(2.0));
    if (z > 6) return 0;  // erfc(6) = 2e-17; mixtures need many values that are 0 or 1
    if (z < -6) return 1;
    return 0.5 * std::erfc(z);
  }
};

/// Natural log density of one measurement y; `t` is y, or log y for the lognormal family. `mean` and `sd` > 0 are in the unit
/// of y, and the density is per this unit. -infinity where a lognormal mean is not positive.
inline double log_density(ObservationFamily family, double t, double mean, double sd) {
  if (family == ObservationFamily::normal) return normal_log_density(t, mean, 1 / sd, std::log(sd));
  return mean > 0 ? lognormal_log_density(t, mean, sd) : -infinity;
}

/// Measurements of one quantity, all with the same standard deviation, in SI.
class Observations {
 public:
  /// `y`: the measurements, SI; positive for the lognormal family, which is not checked.
  Observations(ObservationFamily family, std::vector<double> y)
      : family_(family), y_(std::move(y)) {
    if (family_ == ObservationFamily::lognormal) {
      for (double& value : y_) value = std::log(value);
    }
  }

  /// Sum of log densities where `mean(i)` is the mean of measurement i, SI, and `sd` > 0 the standard
  /// deviation; -infinity where a lognormal mean is not positive.
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
        if (!(mu > 0.0)) return T(-infinity);
        sum += lognormal_log_density(y_[i], mu, sd);
      }
    }
    return sum;
  }

  /// The log density of each measurement, in their order.
  template <class Mean>
  std::vector<double> pointwise(const Mean& mean, double sd) const {
    std::vector<double> terms;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      terms.push_back(log_density(family_, y_[i], mean(i), sd));
    }
    return terms;
  }

  /// The standardized residual of each measurement, in their order.
  template <class Mean>
  std::vector<NormalScore> scores(const Mean& mean, double sd) const {
    std::vector<NormalScore> scores;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      const double z = ObservationDistribution(family_, mean(i), sd).score(y_[i]);
      scores.push_back({z, z});
    }
    return scores;
  }

 private:
  ObservationFamily family_;
  std::vector<double> y_;  // log y for the lognormal family
};

}  // namespace wearwell
