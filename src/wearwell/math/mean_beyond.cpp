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
  // ln of the integrand in u, with x = from + exp(u).
  const auto log_integrand = [&](double u) {
    return u + log_survival(from + std::exp(u)) - at_from;
  };
  // Where half of those that survive `from` are left, within a factor of two.
  double scale = std::log(middle);
  while (scale < farthest && log_survival(from + std::exp(scale)) - at_from > -std::log(2.0))
    scale += std::log(2.0);
  while (scale > -farthest && log_survival(from + std::exp(scale)) - at_from < -2 * std::log(2.0))
    scale -= std::log(2.0);
  if (scale >= farthest) return infinity;
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
  constexpr unsigned depth = 30;
  constexpr double tolerance = 1e-10;
  const auto integrand = [&](double u) { return std::exp(log_integrand(u)); };
  // Below its scale the integrand is nearly exp(u); a threshold is a kink anywhere.
  return Rule::integrate(integrand, scale - negligible, scale, depth, tolerance) +
         Rule::integrate(integrand, scale, high, depth, tolerance) + beyond;
}

}  // namespace wearwell
