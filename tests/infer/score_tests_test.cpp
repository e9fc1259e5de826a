// Numbers are those of tests/golden/score_tests.R where nothing else is said.
#include "wearwell/infer/score_tests.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/infer/residual_shape.h"

namespace wearwell {
namespace {

const std::vector<double> q = {-0.3, 0.4, 1.2, -1.1, 0.7, 0.1, 1.9, -0.6, 0.2, 1.4};
const std::vector<double> w = {1, 2, 3, 4, 5, 6, 7, 8, 9, 11};
const std::vector<std::size_t> level = {1, 1, 2, 2, 3, 3, 2, 1, 3, 2};

std::vector<double> normals(std::size_t n, Rng& rng) {
  std::vector<double> z(n);
  for (double& each : z) each = rng.normal();
  return z;
}

TEST(ScoreTests, AreThoseOfLinearModels) {
  EXPECT_NEAR(scatter_trend_score(q, w), 0.796507254661, 1e-10);
  EXPECT_NEAR(scatter_between_score(q, level), -0.239981120907, 1e-10);
  EXPECT_NEAR(offset_score(q, w), -0.114277039057, 1e-10);
}

TEST(ScoreTests, SizesAreHalfNormalQuantiles) {
  const std::vector<double> size = sizes(std::vector<double>{0.674489750196082, -1.95996398454005});
  EXPECT_NEAR(size[0], 0, 1e-12);
  EXPECT_NEAR(size[1], 1.64485362695147, 1e-9);
}

TEST(ScoreTests, RanksAreCenteredWithinGroups) {
  const std::vector<std::size_t> group = {0, 1, 0, 1, 0};
  EXPECT_EQ(centered_ranks(std::vector<double>{3, 50, 1, 40, 3}, group),
            (std::vector<double>{0.5, 0.5, -1, -0.5, 0.5}));
}

TEST(ScoreTests, TooFewOrConstantResidualsSayNothing) {
  EXPECT_EQ(shape_score(std::vector<double>{1, 2, 3}), 0);
  EXPECT_EQ(shape_score(std::vector<double>(20, 1.5)), 0);
  EXPECT_EQ(scatter_trend_score(std::vector<double>{1, 2}, std::vector<double>{1, 2}), 0);
  EXPECT_EQ(scatter_trend_score(q, std::vector<double>(10, 1)), 0);
}

// Of independent standard normal residuals every score is a standard normal number.
TEST(ScoreTests, HoldTheirLevels) {
  constexpr int samples = 10'000;
  for (const std::size_t n : {6u, 12u, 60u}) {
    std::vector<double> along;
    std::vector<std::size_t> group;
    for (std::size_t i = 0; i < n; ++i) along.push_back(double(i * i)), group.push_back(i % 3);
    const std::array<std::function<double(std::span<const double>)>, 4> tests = {
        [](std::span<const double> z) { return shape_score(z); },
        [&](std::span<const double> z) { return scatter_trend_score(sizes(z), along); },
        [&](std::span<const double> z) { return scatter_between_score(sizes(z), group); },
        [&](std::span<const double> z) { return offset_score(z, along); }};
    std::array<std::array<int, 2>, 4> below{};
    Rng rng(11, n);
    for (int i = 0; i < samples; ++i) {
      const std::vector<double> z = normals(n, rng);
      for (std::size_t t = 0; t < tests.size(); ++t) {
        const double p = normal_cdf(tests[t](z));
        below[t][0] += p < 0.05;
        below[t][1] += p < 0.003;
      }
    }
    for (std::size_t t = 0; t < tests.size(); ++t) {
      // The p values of the Shapiro-Wilk test are approximate, most of all of few.
      const double slack = t == 0 ? 0.25 : 0;
      EXPECT_NEAR(below[t][0], 0.05 * samples, (0.05 * slack * samples) + 4 * 22) << n << " " << t;
      EXPECT_NEAR(below[t][1], 0.003 * samples, (0.003 * slack * samples) + 4 * 5.5)
          << n << " " << t;
    }
  }
}

// Draws that say the same are one; draws that have nothing in common accuse nothing.
TEST(ScoreTests, DrawsAreCombined) {
  EXPECT_NEAR(combined_p(std::vector<double>(50, -2.0), false), normal_cdf(-2.0), 1e-12);
  EXPECT_NEAR(combined_p(std::vector<double>(50, 2.0), true), 2 * normal_cdf(-2.0), 1e-12);
  Rng rng(12, 0);
  for (int i = 0; i < 1000; ++i) EXPECT_GT(combined_p(normals(40, rng), true), 0.01);
  // Half of the variance is the data's: the mean of the draws is N(0, 1/2).
  int below = 0;
  for (int i = 0; i < 10'000; ++i) {
    const double common = rng.normal() * std::sqrt(0.6);
    std::vector<double> scores = normals(100, rng);
    for (double& each : scores) each = common + std::sqrt(0.4) * each;
    below += combined_p(scores, true) < 0.05;
  }
  EXPECT_NEAR(below, 500, 4 * 22 + 25);
}

TEST(ResidualShape, SaysInWhichWay) {
  std::vector<double> even;
  for (int i = 0; i < 40; ++i)
    even.push_back(normal_score(std::log((i + 0.5) / 40), std::log1p(-(i + 0.5) / 40)));
  const auto shape = [&](const std::function<double(double)>& map) {
    std::vector<double> x;
    for (const double z : even) x.push_back(map(z));
    return shape_of(x);
  };
  const ResidualShapeFound groups = shape([](double z) { return z < 0.6 ? z - 4 : z + 4; });
  EXPECT_EQ(groups.shape, ResidualShape::two_groups);
  EXPECT_EQ(groups.lower_group, 29u);
  EXPECT_EQ(shape([](double z) { return std::exp(z); }).shape, ResidualShape::long_upper);
  EXPECT_EQ(shape([](double z) { return -std::exp(z); }).shape, ResidualShape::long_lower);
  EXPECT_EQ(shape([](double z) { return z * z * z; }).shape, ResidualShape::long_tails);
  EXPECT_EQ(shape([](double z) { return normal_cdf(z); }).shape, ResidualShape::short_tails);
}

}  // namespace
}  // namespace wearwell
