#pragma once

#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <cmath>

namespace wearwell {

/// Boost.Math without exceptions, for likelihoods at the extreme parameter values of searches and
/// samplers: infinity on overflow, NaN outside a function's domain and at its poles. Both make the
/// density zero (bayes/posterior.h).
using Quiet = boost::math::policies::policy<
    boost::math::policies::domain_error<boost::math::policies::ignore_error>,
    boost::math::policies::pole_error<boost::math::policies::ignore_error>,
    boost::math::policies::overflow_error<boost::math::policies::ignore_error>,
    boost::math::policies::evaluation_error<boost::math::policies::ignore_error>>;

/// The same without promotion to long double, which is several times slower.
using QuietInDouble =
    boost::math::policies::normalise<Quiet, boost::math::policies::promote_double<false>>::type;

/// Below it the derivative of log Gamma, -1/x, approaches the largest double.
inline constexpr double least_gamma_argument = 1e-300;

/// The derivative of log Gamma(x), x > 0; constant below `least_gamma_argument`.
template <class Policy = QuietInDouble>
double digamma(double x) {
  if (x < least_gamma_argument) return -1 / least_gamma_argument;
  return boost::math::digamma(x, Policy());
}

}  // namespace wearwell
