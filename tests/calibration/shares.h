#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <cstdlib>
#include <string>

namespace wearwell {

// Of a wrong alarm of one expectation of a calibration test; a file has fewer than a hundred of them.
inline constexpr double chance_of_red = 1e-5;

/// How many studies of each kind are simulated: WEARWELL_REPLICATIONS, at least 20, or `otherwise`.
inline int replications(int otherwise) {
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  return wanted ? std::max(20, std::atoi(wanted)) : otherwise;
}

/// No more of `count` than a probability of `share` explains, by the binomial distribution.
inline void expect_share(int found, int count, double share, const std::string& of) {
  const boost::math::binomial_distribution<double> chance(count, share);
  EXPECT_LE(found, quantile(complement(chance, chance_of_red))) << of << ", of " << count;
}

/// Of studies in which one of two tests rejects and the other does not: this one rejects less often by 5 % of all at most.
inline void expect_power(int only_this, int only_classical, int count, const std::string& of) {
  const double error = std::sqrt(std::max(1.0, double(only_this + only_classical)));
  constexpr double farthest = 4.3;  // standard errors, qnorm(1 - 1e-5)
  EXPECT_LE(only_classical - only_this, 0.05 * count + farthest * error) << of << ", of " << count;
}

}  // namespace wearwell
