#include "wearwell/math/mean_beyond.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>

#include "wearwell/math/constants.h"

namespace wearwell {

double mean_beyond(const std::function<double(double x)>& log_survival, double middle,
                   double from) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double farthest = 690;   // ln of the largest x
  constexpr double negligible = 30;  // logarithm of the ignored share of the mean
  if (!(middle > 0) || !std::isfinite(middle)) return nan;
  const double at_from = from > 0 ? log_survival(from) : 0;
  if (!std::isfinite(at_from)) return nan;
  const auto left = [&](double x) { return log_survival(x) - at_from; };
  // Where half of those that survive `from` are left, within a factor of two, beyond `origin`.
  double origin = from, scale = std::log(middle);
  const auto find_scale = [&] {
    const double ln2 = std::log(2.0);
    while (scale < farthest && left(origin + std::exp(scale)) > -ln2) scale += ln2;
    while (scale > -farthest && left(origin + std::exp(scale)) < -2 * ln2) scale -= ln2;
  };
  find_scale();
  if (scale >= farthest) return infinity;
  // All survive to there: a threshold, from which the integrand is smooth in the logarithm.
  constexpr double all = -1e-13;
  double high_end = from + std::exp(scale);
  for (int i = 0; i < 60; ++i) {
    const double between = origin + 0.5 * (high_end - origin);
    (left(between) >= all ? origin : high_end) = between;
  }
  find_scale();
  // ln of the integrand in u, with x = origin + exp(u).
  const auto log_integrand = [&](double u) { return u + left(origin + std::exp(u)); };
  const double least = log_integrand(scale) - negligible;
  double high = scale, step = 1, beyond = 0;
  while (log_integrand(high) > least) {
    high += step;
    step *= 1.25;
    if (high < farthest) continue;
    // A tail like a power of x, whose integral is known.
    high = farthest;
    const double decay = log_integrand(high - 1) - log_integrand(high);
    constexpr double slowest = 1e-3;
    if (!(decay > slowest)) return infinity;
    beyond = std::exp(log_integrand(high)) / decay;
    break;
  }
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  constexpr unsigned depth = 12;
  constexpr double tolerance = 1e-9;  // as the rule estimates it, far above the error
  const auto integrand = [&](double u) { return std::exp(log_integrand(u)); };
  return (origin - from) + Rule::integrate(integrand, scale - negligible, scale, depth, tolerance) +
         Rule::integrate(integrand, scale, high, depth, tolerance) + beyond;
}

}  // namespace wearwell
