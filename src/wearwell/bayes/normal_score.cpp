#include "wearwell/bayes/normal_score.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "wearwell/math/boost_policy.h"

namespace wearwell {
namespace {

// The z < 0 with log Phi(z) = log_p.
double lower_tail(double log_p) {
  constexpr double smallest = -700;  // smallest logarithm of a double
  if (log_p > smallest) {
    return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * std::exp(log_p), QuietInDouble());
  }
  if (std::isinf(log_p)) return log_p;
  // -log Phi(-t) = t^2/2 + log(t sqrt(2 pi)) + 1/t^2 - 5/2 1/t^4 + O(1/t^6).
  double t = std::sqrt(-2 * log_p);
  for (int i = 0; i < 5; ++i) {
    const double rest = 1 / (t * t) - 2.5 / (t * t * t * t);
    t = std::sqrt(-2 * (log_p + std::log(t) + 0.5 * std::log(2 * std::numbers::pi) + rest));
  }
  return -t;
}

}  // namespace

double normal_score(double log_cdf, double log_survival) {
  return log_cdf < log_survival ? lower_tail(log_cdf) : -lower_tail(log_survival);
}

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

}  // namespace wearwell
