#include "wearwell/math/gauss_of_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

std::vector<WeightedPoint> points(int count) {
  Rng rng(20261125, 1);
  std::vector<WeightedPoint> all;
  for (int i = 0; i < count; ++i) all.push_back({3 + 0.1 * rng.normal(), 1 + rng.uniform()});
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return all;
}

double moment(const std::vector<WeightedPoint>& all, int power) {
  double sum = 0;
  for (const WeightedPoint& each : all) sum += each.weight * std::pow((each.at - 3) / 0.3, power);
  return sum;
}

TEST(GaussOfPoints, HasTheSumsOfAllPolynomialsUpToItsDegree) {
  const auto all = points(5000);
  for (const int count : {1, 2, 6}) {
    const auto nodes = gauss_of_points(all, count);
    ASSERT_EQ(std::ssize(nodes), count);
    for (int power = 0; power < 2 * count; ++power) {
      EXPECT_NEAR(moment(nodes, power), moment(all, power), 1e-11 * moment(all, power & ~1))
          << count << " nodes, degree " << power;
    }
    for (const WeightedPoint& each : nodes) {
      EXPECT_GT(each.weight, 0);
      EXPECT_GE(each.at, all.front().at);
      EXPECT_LE(each.at, all.back().at);
    }
  }
}

// Of points that lie evenly the nodes are near those of Gauss and Legendre (Abramowitz and Stegun 1964, table 25.4).
TEST(GaussOfPoints, OfAnEvenMeasureIsGaussAndLegendres) {
  std::vector<WeightedPoint> even;
  constexpr int count = 20'000;
  for (int i = 0; i < count; ++i) even.push_back({-1 + (2 * i + 1.0) / count, 2.0 / count});
  const auto nodes = gauss_of_points(even, 3);
  const double at[] = {-0.774596669241483, 0, 0.774596669241483},
               weight[] = {5 / 9., 8 / 9., 5 / 9.};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(nodes[k].at, at[k], 1e-7);
    EXPECT_NEAR(nodes[k].weight, weight[k], 1e-7);
  }
}

TEST(GaussOfPoints, OfFewDifferentPointsIsThese) {
  const std::vector<WeightedPoint> few = {{1, 2}, {1, 3}, {2, 1}};
  const auto nodes = gauss_of_points(few, 2);
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_EQ(nodes[0].at, 1);
  EXPECT_EQ(nodes[0].weight, 5);
  EXPECT_EQ(nodes[1].at, 2);
  EXPECT_EQ(nodes[1].weight, 1);
}

}  // namespace
}  // namespace wearwell
