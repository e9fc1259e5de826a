#include "wearwell/prognosis/fleet_risk.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>

#include <cmath>

#include "wearwell/base/rng.h"

namespace wearwell::prognosis {
namespace {

TEST(HowMany, OfEqualChancesIsBinomial) {
  const std::vector<double> probability(200, 0.013);
  const Count count = how_many(probability);
  const boost::math::binomial_distribution<> law(200, 0.013);
  ASSERT_EQ(count.size(), 201u);
  for (int k = 0; k <= 200; ++k) {
    const double exact = pdf(law, k);
    EXPECT_NEAR(count[static_cast<std::size_t>(k)], exact, 1e-11 * exact + 1e-300) << k;
  }
}

TEST(HowMany, IsTheSumOverAllSubsets) {
  const std::vector<double> probability = {0.1, 0.9, 0.35, 0.0, 1.0, 0.5, 0.02, 0.77};
  const Count count = how_many(probability);
  Count brute(probability.size() + 1, 0);
  for (unsigned subset = 0; subset < 256; ++subset) {
    double p = 1;
    std::size_t size = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      const bool in = subset >> i & 1;
      p *= in ? probability[i] : 1 - probability[i];
      size += in;
    }
    brute[size] += p;
  }
  for (std::size_t k = 0; k < brute.size(); ++k) EXPECT_NEAR(count[k], brute[k], 1e-15) << k;
  EXPECT_NEAR(mean(count), 3.64, 1e-12);
}

TEST(HowMany, HasTheMomentsOfItsParts) {
  Rng rng(1, 0);
  std::vector<double> probability;
  double sum = 0, variance = 0;
  for (int i = 0; i < 3000; ++i) {
    probability.push_back(std::pow(rng.uniform(), 4));
    sum += probability.back();
    variance += probability.back() * (1 - probability.back());
  }
  const Count count = how_many(probability);
  EXPECT_NEAR(mean(count), sum, 1e-9);
  EXPECT_NEAR(sd(count), std::sqrt(variance), 1e-9);
}

// Units of one population fail together: the same mean, a wider spread.
TEST(HowMany, OfAPopulationInDoubtIsWider) {
  const std::vector<std::vector<double>> probability = {std::vector<double>(100, 0.02),
                                                        std::vector<double>(100, 0.10)};
  const Count mixed = how_many(probability, std::vector<double>{1, 1});
  EXPECT_NEAR(mean(mixed), 6, 1e-12);
  EXPECT_GT(sd(mixed), 1.5 * sd(how_many(std::vector<double>(100, 0.06))));
}

TEST(EnoughFor, IsNotExceeded) {
  const Count count = {0.5, 0.3, 0.15, 0.05};
  EXPECT_EQ(enough_for(count, 0.5), 0u);
  EXPECT_EQ(enough_for(count, 0.8), 1u);
  EXPECT_EQ(enough_for(count, 0.95), 2u);
  EXPECT_EQ(enough_for(count, 0.951), 3u);
  EXPECT_EQ(enough_for(count, 1), 3u);
}

}  // namespace
}  // namespace wearwell::prognosis
