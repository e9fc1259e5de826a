// Lives as weighted points, against a straight line through the middles of points by hand.
#include "wearwell/prognosis/weighted_lives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wearwell::prognosis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

}  // namespace
}  // namespace wearwell::prognosis
