#include "wearwell/prob/standard_distribution.h"

#include "wearwell/prob/standard_values.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/quadrature.h"

namespace wearwell {
namespace {

double log_one_plus_exp(double z) {
  return z > 0 ? z + std::log1p(std::exp(-z)) : std::log1p(std::exp(z));
}

double normal_log_density(double z) {
  return -0.5 * z * z - half_log_two_pi;
}

// Mills' ratio P(Z > t)/density(t) for t >= 20 by its asymptotic series, whose tenth term is below
// 1e-17 there (Abramowitz and Stegun 26.2.12).
double mills_far_out(double t) {
  const double r = 1 / (t * t);
  double term = 1, sum = 1;
  for (int k = 1; k <= 10; ++k) {
    term *= -(2 * k - 1) * r;
    sum += term;
  }
  return sum / t;
}

double normal_log_survival_value(double z) {
  if (z > 20) return normal_log_density(z) + std::log(mills_far_out(z));
  // Near survival 1, the logarithm is computed from the small complement.
  return z < -1 ? std::log1p(-0.5 * std::erfc(-z * M_SQRT1_2))
                : std::log(0.5 * std::erfc(z * M_SQRT1_2));
}

ValueAndSlope normal_log_survival(double z) {
  if (z > 20) {
    const double mills = mills_far_out(z);
    return {normal_log_density(z) + std::log(mills), -1 / mills};
  }
  const double survival = 0.5 * std::erfc(z * M_SQRT1_2);
  const double value = z < -1 ? normal_log_survival_value(z) : std::log(survival);
  return {value, -std::exp(normal_log_density(z)) / survival};
}

// Narrow intervals by Gauss-Legendre about the middle, to avoid cancellation.
double log_narrow_normal(double a, double b) {
  static const GaussLegendre rule = gauss_legendre(12);
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  double sum = 0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double u = half * rule.node[i];
    sum += rule.weight[i] * std::exp(-u * (middle + 0.5 * u));
  }
  return normal_log_density(middle) + std::log(half * sum);
}

double log_between_normal(double a, double b) {
  if (b <= 0) return log_between_normal(-b, -a);
  if ((b - a) * std::max({1.0, std::abs(a), std::abs(b)}) < 2) return log_narrow_normal(a, b);
  if (a < 0) {
    const double outside = 0.5 * (std::erfc(-a * M_SQRT1_2) + std::erfc(b * M_SQRT1_2));
    return std::log1p(-outside);
  }
  const double above_a = normal_log_survival(a).value;
  return above_a + std::log1p(-std::exp(normal_log_survival(b).value - above_a));
}

double log_between_extreme(double a, double b) {
  // P(a < Z <= b) = exp(-e^a) (1 - exp(-(e^b - e^a))), e^b - e^a without cancellation.
  const double step = std::exp(a) * std::expm1(b - a);
  return -std::exp(a) + std::log(-std::expm1(-step));
}

// P(a < Z <= b) = P(Z <= b) P(Z > a) (1 - exp(a - b)).
double log_between_logistic(double a, double b) {
  return -log_one_plus_exp(-b) - log_one_plus_exp(a) + std::log(-std::expm1(a - b));
}

double log_probability_between(StandardDistribution distribution, double a, double b) {
  switch (distribution) {
    case StandardDistribution::smallest_extreme_value:
      return log_between_extreme(a, b);
    case StandardDistribution::largest_extreme_value:
      return log_between_extreme(-b, -a);
    case StandardDistribution::logistic:
      return log_between_logistic(a, b);
    case StandardDistribution::normal:
      break;
  }
  return log_between_normal(a, b);
}

ValueAndSlope extreme_log_density(double z) {
  const double e = std::exp(z);
  return {z - e, 1 - e};
}

ValueAndSlope extreme_log_survival(double z) {
  const double e = std::exp(z);
  return {-e, -e};
}

ValueAndSlope extreme_log_cdf(double z) {
  const double e = std::exp(z);
  // exp(z - e^z)/(1 - exp(-e^z)), the density over the probability.
  if (z < -37) return {z, 1};
  return {e < 1 ? std::log(-std::expm1(-e)) : std::log1p(-std::exp(-e)),
          e > 700 ? 0 : e / std::expm1(e)};
}

ValueAndSlope logistic_log_survival(double z) {
  return {-log_one_plus_exp(z), -1 / (1 + std::exp(-z))};
}

// For the mirrored distribution, at the mirrored position.
ValueAndSlope mirrored(ValueAndSlope y) {
  return {y.value, -y.slope};
}

}  // namespace

ValueAndSlope log_density_and_slope(StandardDistribution distribution, double z) {
  switch (distribution) {
    case StandardDistribution::smallest_extreme_value:
      return extreme_log_density(z);
    case StandardDistribution::largest_extreme_value:
      return mirrored(extreme_log_density(-z));
    case StandardDistribution::logistic:
      return {-std::abs(z) - 2 * std::log1p(std::exp(-std::abs(z))), -std::tanh(0.5 * z)};
    case StandardDistribution::normal:
      break;
  }
  return {normal_log_density(z), -z};
}

ValueAndSlope log_survival_and_slope(StandardDistribution distribution, double z) {
  switch (distribution) {
    case StandardDistribution::smallest_extreme_value:
      return extreme_log_survival(z);
    case StandardDistribution::largest_extreme_value:
      return mirrored(extreme_log_cdf(-z));
    case StandardDistribution::logistic:
      return logistic_log_survival(z);
    case StandardDistribution::normal:
      break;
  }
  return normal_log_survival(z);
}

ValueAndSlope log_cdf_and_slope(StandardDistribution distribution, double z) {
  switch (distribution) {
    case StandardDistribution::smallest_extreme_value:
      return extreme_log_cdf(z);
    case StandardDistribution::largest_extreme_value:
      return mirrored(extreme_log_survival(-z));
    case StandardDistribution::logistic:
      return mirrored(logistic_log_survival(-z));
    case StandardDistribution::normal:
      break;
  }
  return mirrored(normal_log_survival(-z));
}

double log_survival_value(StandardDistribution distribution, double z) {
  return distribution == StandardDistribution::normal
             ? normal_log_survival_value(z)
             : log_survival_and_slope(distribution, z).value;
}

double log_cdf_value(StandardDistribution distribution, double z) {
  return distribution == StandardDistribution::normal ? normal_log_survival_value(-z)
                                                      : log_cdf_and_slope(distribution, z).value;
}

LogBetween log_between_and_slopes(StandardDistribution distribution, double a, double b) {
  if (a == -infinity) {
    const ValueAndSlope y = log_cdf_and_slope(distribution, b);
    return {y.value, 0, y.slope};
  }
  if (b == infinity) {
    const ValueAndSlope y = log_survival_and_slope(distribution, a);
    return {y.value, y.slope, 0};
  }
  const double value = log_probability_between(distribution, a, b);
  return {value, -std::exp(log_density_and_slope(distribution, a).value - value),
          std::exp(log_density_and_slope(distribution, b).value - value)};
}

double cdf(StandardDistribution distribution, double z) {
  switch (distribution) {
    case StandardDistribution::smallest_extreme_value:
      return -std::expm1(-std::exp(z));
    case StandardDistribution::largest_extreme_value:
      return std::exp(-std::exp(-z));
    case StandardDistribution::logistic:
      return 1 / (1 + std::exp(-z));
    case StandardDistribution::normal:
      break;
  }
  return 0.5 * std::erfc(-z * M_SQRT1_2);
}

double quantile(StandardDistribution distribution, double p) {
  switch (distribution) {
    case StandardDistribution::smallest_extreme_value:
      return std::log(-std::log1p(-p));
    case StandardDistribution::largest_extreme_value:
      return -std::log(-std::log(p));
    case StandardDistribution::logistic:
      return std::log(p) - std::log1p(-p);
    case StandardDistribution::normal:
      break;
  }
  return -M_SQRT2 * boost::math::erfc_inv(2 * p, Quiet());
}

double upper_quantile(StandardDistribution distribution, double q) {
  switch (distribution) {
    case StandardDistribution::smallest_extreme_value:
      return std::log(-std::log(q));
    case StandardDistribution::largest_extreme_value:
      return -std::log(-std::log1p(-q));
    case StandardDistribution::logistic:
    case StandardDistribution::normal:
      break;
  }
  return -quantile(distribution, q);
}

}  // namespace wearwell
