// Lives as weighted points, against a straight line through the middles of points by hand.
#include "wearwell/prognosis/weighted_lives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/math/constants.h"
#include "wearwell/prognosis/weighted_quantiles.h"

namespace wearwell::prognosis {
namespace {

WeightedLives lives(const std::vector<double>& life, const std::vector<double>& weight) {
  return WeightedLives(life, weight);
}

TEST(WeightedLives, GoStraightBetweenTheMiddlesOfPoints) {
  // In any order, weights of any sum; a weight of 0 and what is no number do not count.
  const WeightedLives some =
      lives({30, 10, 20, 5, std::nan("")}, {1, 1, 2, 0, 3});  // middles at 1/8, 4/8, 7/8
  EXPECT_DOUBLE_EQ(some.cdf(9.9), 0);
  EXPECT_DOUBLE_EQ(some.cdf(10), 0.125);
  EXPECT_DOUBLE_EQ(some.cdf(15), 0.3125);
  EXPECT_DOUBLE_EQ(some.cdf(20), 0.5);
  EXPECT_DOUBLE_EQ(some.cdf(31), 1);
  for (const double p : {0.2, 0.3125, 0.5, 0.8}) EXPECT_NEAR(some.cdf(some.quantile(p)), p, 1e-15);
  EXPECT_DOUBLE_EQ(some.quantile(0.05), 10);
  EXPECT_DOUBLE_EQ(some.quantile(0.95), 30);
  // What is lived until 20: 10, then 10 of which 7/8 to 4/8 live.
  EXPECT_DOUBLE_EQ(some.mean_up_to(5), 5);
  EXPECT_DOUBLE_EQ(some.mean_up_to(20), 10 + 10 * (0.875 + 0.5) / 2);
  EXPECT_DOUBLE_EQ(some.mean_up_to(100), 20);
  EXPECT_DOUBLE_EQ(some.mean_up_to(infinity), 20);
}

// Even points: the p-quantile is p, so that 1 % of probability is a fifth of the 5 % quantile.
TEST(WeightedLives, AnErrorOfProbabilityIsOneOfTheLife) {
  std::vector<double> life, weight(1000, 1);
  for (int i = 0; i < 1000; ++i) life.push_back((i + 0.5) / 1000);
  EXPECT_NEAR(relative_error(lives(life, weight), 0.01), 0.2, 1e-12);
  EXPECT_NEAR(relative_error(lives(life, weight), 0.001), 0.02, 1e-12);
  EXPECT_EQ(relative_error(lives({7}, {1}), 0.01), 0);
  EXPECT_EQ(relative_error(WeightedLives(), 0.01), 0);
  EXPECT_EQ(relative_error(lives({infinity}, {1}), 0.01), 0);
}

TEST(WeightedLives, EqualOnesAreOnePoint) {
  const WeightedLives two = lives({3, 1, 3}, {1, 1, 2});
  EXPECT_EQ(two.points().size(), 2u);
  EXPECT_DOUBLE_EQ(two.weights()[1], 0.75);
  EXPECT_DOUBLE_EQ(two.cdf(3), 1);
}

TEST(WeightedLives, SomeNeverReachTheLimit) {
  const WeightedLives some = lives({10, infinity, 20}, {1, 2, 1});
  EXPECT_DOUBLE_EQ(some.cdf(1e9), 0.5);
  EXPECT_DOUBLE_EQ(some.quantile(0.45), 20);
  EXPECT_EQ(some.quantile(0.55), infinity);
  EXPECT_DOUBLE_EQ(some.mean_up_to(120), 10 + 10 * (0.875 + 0.625) / 2 + 50);
  EXPECT_EQ(some.mean_up_to(infinity), infinity);
  EXPECT_EQ(lives({infinity}, {1}).quantile(0.01), infinity);
  EXPECT_DOUBLE_EQ(lives({infinity}, {1}).mean_up_to(7), 7);
}

// P(life <= x + y | life > x), whatever x.
TEST(WeightedLives, WhatRemainsToThoseThatLive) {
  std::vector<double> life, weight;
  for (int i = 0; i < 400; ++i) {
    life.push_back(10 + 0.1 * i);
    weight.push_back(1 + std::sin(0.05 * i));
  }
  const WeightedLives some = lives(life, weight);
  for (const double x : {0.0, 5.0, 10.0, 23.04, 23.05, 23.09, 40.0}) {
    const WeightedLives left = some.beyond(x);
    for (const double y : {6.0, 12.5, 20.0}) {
      const double wanted = (some.cdf(x + y) - some.cdf(x)) / (1 - some.cdf(x));
      EXPECT_NEAR(left.cdf(y), wanted, 2e-3) << x << " " << y;
    }
  }
  EXPECT_TRUE(some.beyond(60).points().empty());
  EXPECT_TRUE(std::isnan(some.beyond(60).quantile(0.5)));
  EXPECT_TRUE(std::isnan(WeightedLives().quantile(0.5)));
}

// Lives of every size and closeness, of both signs, equal, infinite: sorted as by comparison.
TEST(WeightedLives, OfAnySizeAreSorted) {
  Rng rng(31, 1);
  for (int kind = 0; kind < 7; ++kind) {
    for (const std::size_t count : {1U, 7U, 300U, 10'000U}) {
      std::vector<double> life, weight;
      for (std::size_t i = 0; i < count; ++i) {
        const double z = rng.normal();
        const double each[] = {std::exp(z),
                               z,
                               std::exp(200 * z),
                               1 + 1e-15 * std::floor(10 * z),
                               i == 0 ? 1e-300 : 1e3 + 1e-9 * z,
                               std::floor(z),
                               i % 3 == 0 ? infinity : z};
        life.push_back(each[kind]);
        weight.push_back(i % 5 == 0 ? 0.0 : rng.uniform(0, 1));
      }
      const WeightedLives sorted = lives(life, weight);
      std::vector<std::pair<double, double>> expected;
      for (std::size_t i = 0; i < count; ++i) {
        if (weight[i] > 0) expected.emplace_back(life[i], weight[i]);
      }
      std::stable_sort(expected.begin(), expected.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
      std::vector<double> points;
      for (const auto& [each, own] : expected) {
        if (points.empty() || points.back() != each) points.push_back(each);
      }
      EXPECT_TRUE(
          std::equal(points.begin(), points.end(), sorted.points().begin(), sorted.points().end()))
          << kind << " " << count;
      const std::vector<double> at = {0.001, 0.05, 0.1, 0.5, 0.77, 0.95, 0.999};
      const std::vector<double> quantiles = weighted_quantiles(life, weight, at);
      for (std::size_t k = 0; k < at.size(); ++k) {
        const double wanted = sorted.quantile(at[k]);
        if (std::isfinite(wanted)) {
          // Where two points lie far apart, what rounding does to p is as much of their distance.
          EXPECT_NEAR(quantiles[k], wanted, 1e-9 * std::abs(wanted)) << kind << " " << count;
        } else {
          EXPECT_EQ(std::isnan(quantiles[k]), std::isnan(wanted)) << kind << " " << count;
          EXPECT_EQ(std::isinf(quantiles[k]), std::isinf(wanted)) << kind << " " << count;
        }
      }
    }
  }
  EXPECT_TRUE(std::isnan(weighted_quantiles(std::vector<double>{1.0}, std::vector<double>{0.0},
                                            std::vector<double>{0.5})[0]));
}

}  // namespace
}  // namespace wearwell::prognosis
