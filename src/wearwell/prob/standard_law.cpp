#include "wearwell/prob/standard_law.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>

#include "wearwell/math/quadrature.h"

namespace wearwell {
namespace {

constexpr double half_log_two_pi = 0.91893853320467274178;
constexpr double infinity = std::numeric_limits<double>::infinity();

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

ValueAndSlope normal_log_survival(double z) {
  if (z > 20) {
    const double mills = mills_far_out(z);
    return {normal_log_density(z) + std::log(mills), -1 / mills};
  }
  const double survival = 0.5 * std::erfc(z * M_SQRT1_2);
  // Where nearly all survive, the logarithm comes from the small rest.
  const double value = z < -1 ? std::log1p(-0.5 * std::erfc(-z * M_SQRT1_2)) : std::log(survival);
  return {value, -std::exp(normal_log_density(z)) / survival};
}

// Narrow intervals by Gauss-Legendre about the middle, where a difference would cancel.
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

}  // namespace

ValueAndSlope log_density_and_slope(StandardLaw law, double z) {
  if (law == StandardLaw::normal) return {normal_log_density(z), -z};
  const double e = std::exp(z);
  return {z - e, 1 - e};
}

ValueAndSlope log_survival_and_slope(StandardLaw law, double z) {
  if (law == StandardLaw::normal) return normal_log_survival(z);
  const double e = std::exp(z);
  return {-e, -e};
}

ValueAndSlope log_cdf_and_slope(StandardLaw law, double z) {
  if (law == StandardLaw::normal) {
    const ValueAndSlope mirrored = normal_log_survival(-z);
    return {mirrored.value, -mirrored.slope};
  }
  const double e = std::exp(z);
  // exp(z - e^z)/(1 - exp(-e^z)), the density over the probability.
  if (z < -37) return {z, 1};
  return {e < 1 ? std::log(-std::expm1(-e)) : std::log1p(-std::exp(-e)),
          e > 700 ? 0 : e / std::expm1(e)};
}

LogBetween log_between_and_slopes(StandardLaw law, double a, double b) {
  if (a == -infinity) {
    const ValueAndSlope y = log_cdf_and_slope(law, b);
    return {y.value, 0, y.slope};
  }
  if (b == infinity) {
    const ValueAndSlope y = log_survival_and_slope(law, a);
    return {y.value, y.slope, 0};
  }
  const double value =
      law == StandardLaw::normal ? log_between_normal(a, b) : log_between_extreme(a, b);
  return {value, -std::exp(log_density_and_slope(law, a).value - value),
          std::exp(log_density_and_slope(law, b).value - value)};
}

double cdf(StandardLaw law, double z) {
  return law == StandardLaw::normal ? 0.5 * std::erfc(-z * M_SQRT1_2) : -std::expm1(-std::exp(z));
}

double quantile(StandardLaw law, double p) {
  return law == StandardLaw::normal ? -M_SQRT2 * boost::math::erfc_inv(2 * p)
                                    : std::log(-std::log1p(-p));
}

}  // namespace wearwell
