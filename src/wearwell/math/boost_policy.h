#pragma once

#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <cmath>

namespace wearwell {

/// Boost.Math without exceptions, for whatever a likelihood evaluates at parameter values as extreme
/// as a search or a sampler tries them: infinity where a result is too large, NaN outside a
/// function's domain and at its poles. Both make the density zero (bayes/posterior.h).
using Quiet = boost::math::policies::policy<
    boost::math::policies::domain_error<boost::math::policies::ignore_error>,
    boost::math::policies::pole_error<boost::math::policies::ignore_error>,
    boost::math::policies::overflow_error<boost::math::policies::ignore_error>,
    boost::math::policies::evaluation_error<boost::math::policies::ignore_error>>;

/// The same not in long double, which is several times as expensive.
using QuietInDouble =
    boost::math::policies::normalise<Quiet, boost::math::policies::promote_double<false>>::type;

/// Below it the derivative of log Gamma, -1/x, comes near the largest double.
inline constexpr double least_gamma_argument = 1e-300;

/// The derivative of log Gamma(x), x > 0; that at `least_gamma_argument` below it.
template <class Policy = QuietInDouble>
double digamma(double x) {
  if (x < least_gamma_argument) return -1 / least_gamma_argument;
  return boost::math::digamma(x, Policy());
}

}  // namespace wearwell
