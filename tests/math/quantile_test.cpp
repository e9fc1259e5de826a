#include "wearwell/math/quantile.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

namespace wearwell {
namespace {

// R 4.2.2: x <- c(1, 2, 4, 8, 16, 32); quantile(x, c(0, .05, .3, .5, .6, .95, 1), type = 7)
TEST(Quantile, IsTypeSevenOfR) {
  const std::vector<double> x{1, 2, 4, 8, 16, 32};
  EXPECT_DOUBLE_EQ(quantile(x, 0), 1);
  EXPECT_DOUBLE_EQ(quantile(x, 0.05), 1.25);
  EXPECT_DOUBLE_EQ(quantile(x, 0.3), 3);
  EXPECT_DOUBLE_EQ(quantile(x, 0.5), 6);
  EXPECT_DOUBLE_EQ(quantile(x, 0.6), 8);
  EXPECT_DOUBLE_EQ(quantile(x, 0.95), 28);
  EXPECT_DOUBLE_EQ(quantile(x, 1), 32);
  EXPECT_EQ(quantile(std::vector<double>{7}, 0.3), 7);
}

// By hand: weights 1 and 3 are worth n = 16/10 draws; the window of the median is
// [0.3, 1.3]/1.6, of which the first value holds [0.3, 0.4]/1.6, a tenth.
TEST(WeightedQuantile, WeighsTheValuesInTheWindow) {
  EXPECT_NEAR(quantile(std::vector<double>{0, 1}, std::vector<double>{1, 3}, 0.5), 0.9, 1e-15);
}

std::vector<double> ascending() {
  auto x = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(
      rc::gen::map(rc::gen::inRange(-1000, 1000), [](int i) { return i / 8.0; })));
  std::sort(x.begin(), x.end());
  return x;
}

double probability() {
  return *rc::gen::inRange(0, 1001) / 1000.0;
}

RC_GTEST_PROP(WeightedQuantile, OfEqualWeightsIsTheQuantile, ()) {
  const auto x = ascending();
  const double p = probability();
  const std::vector<double> weights(x.size(), *rc::gen::inRange(1, 100) / 7.0);
  RC_ASSERT(std::abs(quantile(x, weights, p) - quantile(x, p)) < 1e-9);
}

RC_GTEST_PROP(WeightedQuantile, DoesNotSeeWeightlessValues, ()) {
  const auto x = ascending();
  const double p = probability();
  std::vector<double> weights, some, their_weights;
  const auto heavy = *rc::gen::inRange<std::size_t>(0, x.size());  // at least one has weight
  for (std::size_t i = 0; i < x.size(); ++i) {
    weights.push_back(*rc::gen::inRange(i == heavy ? 1 : 0, 4));
    if (weights.back() > 0) {
      some.push_back(x[i]);
      their_weights.push_back(weights.back());
    }
  }
  RC_ASSERT(std::abs(quantile(x, weights, p) - quantile(some, their_weights, p)) < 1e-9);
}

RC_GTEST_PROP(WeightedQuantile, RisesWithProbability, ()) {
  const auto x = ascending();
  const auto weights = *rc::gen::container<std::vector<double>>(
      x.size(), rc::gen::map(rc::gen::inRange(1, 50), [](int i) { return i / 10.0; }));
  const double p = probability(), q = probability();
  RC_ASSERT(quantile(x, weights, std::min(p, q)) <= quantile(x, weights, std::max(p, q)) + 1e-9);
}

}  // namespace
}  // namespace wearwell
