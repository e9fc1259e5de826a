#include "wearwell/bayes/observation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

const std::vector<double> measured{4.44e-9, 5.105e-9, 8.825e-9};  // m^3
const double mean[] = {1e-9, 2e-9, 9e-9}, sd = 2.5e-9;

double log_likelihood(ObservationFamily family) {
  return Observations(family, measured)
      .log_likelihood<double>([](std::size_t i) { return mean[i]; }, sd);
}

// R 4.2.2: v <- c(4.44, 5.105, 8.825)/1e9; mu <- c(1, 2, 9)/1e9; sd <- 2.5e-9;
// sum(dnorm(v, mu, sd, log = TRUE));
// z <- sqrt(log1p((sd/mu)^2)); sum(dlnorm(v, log(mu) - z^2/2, z, log = TRUE))
TEST(Observations, MatchR) {
  EXPECT_NEAR(log_likelihood(ObservationFamily::normal), 54.943689715602744, 1e-12);
  EXPECT_NEAR(log_likelihood(ObservationFamily::lognormal), 52.494154584276387, 1e-12);
}

double observation_cdf(ObservationFamily family, double y, double mu, double spread) {
  return ObservationDistribution(family, mu, spread)
      .cdf(family == ObservationFamily::normal ? y : std::log(y));
}

// R: pnorm(8, 5, 2.5); z <- sqrt(log1p(.25)); plnorm(8, log(5) - z^2/2, z)
TEST(ObservationDistribution, MatchesR) {
  EXPECT_NEAR(observation_cdf(ObservationFamily::normal, 8, 5, 2.5), 0.88493032977829178, 1e-15);
  EXPECT_NEAR(observation_cdf(ObservationFamily::lognormal, 8, 5, 2.5), 0.89086814889446053, 1e-15);
  EXPECT_EQ(observation_cdf(ObservationFamily::lognormal, 0, 5, 2.5), 0);
}

TEST(Observations, LognormalMeanMustBePositive) {
  const Observations one(ObservationFamily::lognormal, {1});
  for (const double mu : {0.0, -1.0}) {
    EXPECT_EQ(one.log_likelihood<double>([&](std::size_t) { return mu; }, 1.0), -infinity);
  }
}

// As its mean goes to 0 at a constant standard deviation, a lognormal quantity goes to 0 (its
// median is mean^2/sqrt(mean^2 + sd^2)).
TEST(ObservationDistribution, VanishingLognormalMean) {
  for (const double mu : {1e-150, 1e-200, 1e-300, 0.0}) {
    EXPECT_GT(observation_cdf(ObservationFamily::lognormal, 1, mu, 2), 1 - 1e-15) << mu;
  }
}

}  // namespace
}  // namespace wearwell
