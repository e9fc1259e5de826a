#pragma once

#include <cmath>
#include <limits>

#include "wearwell/math/dual.h"

namespace wearwell {

/// A standard distribution on the whole line for life models: log life, or life itself, is location
/// + scale times a standard variable. A smallest extreme value log life means a Weibull life, a
/// logistic log life a loglogistic life.
enum class StandardDistribution { normal, smallest_extreme_value, largest_extreme_value, logistic };

/// A function's value and its derivative.
struct ValueAndSlope {
  double value = 0;
  double slope = 0;
};

/// Logarithms of the density, of the distribution function P(Z <= z) and of survival P(Z > z).
/// Accurate far in the tails: at z = 300 the normal log survival is -45006.62...
ValueAndSlope log_density_and_slope(StandardDistribution distribution, double z);
ValueAndSlope log_cdf_and_slope(StandardDistribution distribution, double z);
ValueAndSlope log_survival_and_slope(StandardDistribution distribution, double z);

/// log P(a < Z <= b) for a < b, with its derivatives by both.
struct LogBetween {
  double value = 0;
  double slope_a = 0;
  double slope_b = 0;
};
LogBetween log_between_and_slopes(StandardDistribution distribution, double a, double b);

double cdf(StandardDistribution distribution, double z);

/// The z with P(Z <= z) = p, 0 < p < 1.
double quantile(StandardDistribution distribution, double p);
/// The z with P(Z > z) = q.
double upper_quantile(StandardDistribution distribution, double q);

/// The same for a formula's scalar: double or Dual.
template <class T>
T log_density(StandardDistribution distribution, const T& z) {
  const ValueAndSlope y = log_density_and_slope(distribution, scalar(z));
  return chained(z, y.value, y.slope);
}
template <class T>
T log_cdf(StandardDistribution distribution, const T& z) {
  const ValueAndSlope y = log_cdf_and_slope(distribution, scalar(z));
  return chained(z, y.value, y.slope);
}
template <class T>
T log_survival(StandardDistribution distribution, const T& z) {
  const ValueAndSlope y = log_survival_and_slope(distribution, scalar(z));
  return chained(z, y.value, y.slope);
}
template <class T>
T log_between(StandardDistribution distribution, const T& a, const T& b) {
  const LogBetween y = log_between_and_slopes(distribution, scalar(a), scalar(b));
  return chained(a, y.value, y.slope_a) + chained(b, 0, y.slope_b);
}

}  // namespace wearwell
