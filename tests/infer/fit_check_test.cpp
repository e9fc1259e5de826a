#include "wearwell/infer/fit_check.h"
#include "wearwell/infer/judged_counts.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/infer/residual_tests.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

std::vector<double> normals(std::size_t n, Rng& rng) {
  std::vector<double> z(n);
  for (double& each : z) each = rng.normal();
  return z;
}

// The share of 20,000 samples with a p value below each level: the level, within four standard
// errors and `slack` of it.
void expect_level(const ResidualTest& test, std::size_t n, double slack) {
  constexpr int samples = 20'000;
  const std::array<double, 3> levels = {0.2, 0.05, 0.005};
  std::array<int, 3> below{};
  Rng rng(7, n);
  for (int i = 0; i < samples; ++i) {
    const double p = test(normals(n, rng));
    ASSERT_GE(p, 0);
    ASSERT_LE(p, 1);
    for (std::size_t l = 0; l < levels.size(); ++l) below[l] += p < levels[l];
  }
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const double share = below[l] / double(samples);
    const double error = std::sqrt(levels[l] * (1 - levels[l]) / samples);
    EXPECT_NEAR(share, levels[l], 4 * error + slack * levels[l]) << n << " at " << levels[l];
  }
}

TEST(ResidualTests, HoldTheirLevels) {
  for (const std::size_t n : {5u, 12u, 60u}) {
    expect_level(scatter_test, n, 0);
    expect_level(location_test, n, 0);
    std::vector<double> driver(n);
    for (std::size_t i = 0; i < n; ++i) driver[i] = 1e4 * std::pow(double(i), 2);
    expect_level([&](std::span<const double> z) { return trend_test(z, driver); }, n, 0);
    expect_level(neighbour_test, n, n > 40 ? 0.1 : 0);  // beyond, from two moments and the range
    const auto fall = [&](std::span<const double> z) {
      return fall_test({"", driver, {z.begin(), z.end()}, {}, true});
    };
    expect_level(fall, n, 0);
    const auto sign = [&](std::span<const double> z) {
      return sign_test({"", driver, {z.begin(), z.end()}, {}, true});
    };
    expect_level(sign, n, 0);
  }
}

// Of the bound of Bonferroni only the tail is exact.
TEST(ResidualTests, ExtremeHoldsItsTail) {
  constexpr int samples = 50'000;
  for (const std::size_t n : {5u, 12u}) {
    int below = 0;
    Rng rng(8, n);
    for (int i = 0; i < samples; ++i) below += extreme_test(normals(n, rng)) < 0.01;
    EXPECT_LE(below, 0.01 * samples + 4 * std::sqrt(0.01 * samples)) << n;
    EXPECT_GE(below, 0.006 * samples) << n;
  }
}

TEST(ResidualTests, SeeWhatTheyAreFor) {
  const std::vector<double> along = {1, 2, 3, 4, 5, 6, 7, 8};
  const std::vector<double> rising = {-1.6, -1.1, -0.8, -0.2, 0.3, 0.6, 1.2, 1.5};
  const std::vector<double> bent = {-1, -0.2, 0.5, 1, 1.1, 0.4, -0.3, -1.1};
  std::vector<double> outlier = {0.1, -0.05, 0.02, 0.08, -0.1, 0.03, 0.06, 3};
  EXPECT_LT(trend_test(rising, along), 1e-5);
  EXPECT_LT(neighbour_test(bent), 0.01);
  EXPECT_LT(extreme_test(outlier), 1e-5);
  EXPECT_GT(extreme_test(rising), 0.5);
  std::vector<double> large = rising;
  for (double& z : large) z *= 10;
  EXPECT_LT(scatter_test(large), 1e-10);
  EXPECT_NEAR(trend_test(large, along) / trend_test(rising, along), 1, 1e-9);
}

// By hand: two items whose levels differ, wear falls within each.
TEST(ResidualTests, FallsWithinItems) {
  const Rise items{
      "", {1, 2, 3, 1, 2, 3}, {30, 20.1, 10, 5000, 4990, 4980.1}, {0, 0, 0, 1, 1, 1}, true};
  EXPECT_LT(fall_test(items), 1e-4);
  EXPECT_GT(fall_test({"", items.driver, items.value, {}, true}), 0.1);
}

// y ~ N(mu, 1) with mu flat: posterior draws of mu are N(mean, 1/n).
struct FlatMean {
  std::vector<double> y;
  WeightedDraws draws;
  FitData data;

  FlatMean(std::vector<double> values, std::vector<double> along, std::size_t censored = 0)
      : y(std::move(values)) {
    Rng rng(3, 0);
    double mean = 0;
    for (const double each : y) mean += each / double(y.size());
    draws.values.resize(500, 1);
    for (int i = 0; i < 500; ++i)
      draws.values(i, 0) = mean + rng.normal() / std::sqrt(double(y.size()));
    draws.weights = Eigen::VectorXd::Constant(500, 1. / 500);
    data.scores = [*this, censored](const double* x) {
      std::vector<NormalScore> scores;
      for (std::size_t i = 0; i < y.size(); ++i) {
        const double z = y[i] - x[0];
        scores.push_back({z, i < censored ? INFINITY : z});
      }
      return scores;
    };
    data.drivers = {{"work", std::move(along)}};
  }
};

TEST(FitCheck, NamesWhatIsWrong) {
  std::vector<double> along;
  for (int i = 0; i < 20; ++i) along.push_back(i);
  Rng rng(4, 0);
  std::vector<double> right = normals(20, rng), trend = right, outlier = right;
  for (std::size_t i = 0; i < 20; ++i) trend[i] += 0.5 * double(i);
  outlier[6] = 30;
  const auto verdict = [&](const std::vector<double>& y) {
    const FlatMean normal(y, along);
    return fit_check(judge_fit(normal.data, normal.draws, {}));
  };
  EXPECT_EQ(verdict(right).verdict, Verdict::pass) << verdict(right).detail;
  EXPECT_EQ(verdict(trend).verdict, Verdict::fail);
  EXPECT_THAT(verdict(trend).detail, HasSubstr("residuals have a trend with work"));
  EXPECT_EQ(verdict(outlier).verdict, Verdict::fail);
  EXPECT_THAT(verdict(outlier).detail, HasSubstr("row 7 is an outlier"));
}

// A table that is sorted by what was observed, as tables of lives are: at one stress that says nothing.
TEST(FitCheck, SortedTablesAreNotBent) {
  Rng rng(6, 0);
  std::vector<double> y, along;
  for (int level = 0; level < 3; ++level) {
    std::vector<double> here = normals(12, rng);
    std::sort(here.begin(), here.end());
    y.insert(y.end(), here.begin(), here.end());
    along.insert(along.end(), here.size(), level);
  }
  const FlatMean normal(y, along);
  const Check check = fit_check(judge_fit(normal.data, normal.draws, {}));
  EXPECT_EQ(check.verdict, Verdict::pass) << check.detail;
}

// A run-out's score is drawn from beyond where it was stopped: whoever took the stop for the life
// would see too many that are short.
TEST(FitCheck, RunOutsAreDrawn) {
  Rng rng(5, 0);
  constexpr std::size_t n = 60;
  std::vector<double> life = normals(n, rng);
  const std::vector<double> along = normals(n, rng);
  std::partition(life.begin(), life.end(), [](double y) { return y > 0; });
  std::size_t stopped = 0;
  for (double& y : life) {
    if (y > 0) y = 0, ++stopped;
  }
  FlatMean normal(life, along, stopped);
  for (int i = 0; i < 500; ++i) normal.draws.values(i, 0) = 0.1 * rng.normal();
  EXPECT_EQ(fit_check(judge_fit(normal.data, normal.draws, {})).verdict, Verdict::pass);
  const FlatMean as_failures(life, along, 0);
  EXPECT_LT(judge_fit(as_failures.data, normal.draws, {}).p, 0.001);
}

TEST(NormalScore, KeepsTheDigitsOfBothTails) {
  for (const double z : {-300., -40., -9., -2., 0.5, 3., 8., 45., 500.}) {
    const double score =
        normal_score(log_cdf_and_slope(StandardDistribution::normal, z).value,
                     log_survival_and_slope(StandardDistribution::normal, z).value);
    EXPECT_NEAR(score, z, 1e-7 * std::abs(z)) << z;
  }
  EXPECT_EQ(normal_score(0, -INFINITY), INFINITY);
  EXPECT_EQ(normal_score(-INFINITY, 0), -INFINITY);
}

// Readings that are all zero under a law through zero: what is left is rounding.
TEST(ResidualTests, RoundingIsNoTrend) {
  const std::vector<double> z = {-1e-17, -2e-17, -3e-17, -4e-17, -5e-17}, along = {1, 2, 3, 4, 5};
  EXPECT_EQ(trend_test(z, along), 1);
  EXPECT_EQ(neighbour_test(z), 1);
  const std::vector<double> rising = {-2, -1, 0, 1, 2};
  EXPECT_LT(trend_test(rising, along), 1e-6);
}

// Scores of very many rows that are the same under every draw.
FitOutcome judged(const std::vector<double>& z) {
  FitData data;
  data.scores = [&](const double*) {
    std::vector<NormalScore> all;
    for (const double each : z) all.push_back({each, each});
    return all;
  };
  WeightedDraws draws;
  draws.values = Eigen::MatrixXd::Zero(50, 1);
  draws.weights = Eigen::VectorXd::Constant(50, 0.02);
  return judge_fit(data, draws, {});
}

// 4190 survivors in one row, and the 300 that failed before: of both the same share is judged.
TEST(FitCheck, OneRowOfManySurvivorsIsNoMisfit) {
  constexpr double stop = -1.5;
  Rng rng(8, 0);
  FitData data;
  std::vector<NormalScore> scores;
  while (scores.size() < 300)
    if (const double z = rng.normal(); z < stop) scores.push_back({z, z});
  scores.push_back({stop, INFINITY});
  data.counts.assign(300, 1);
  data.counts.push_back(4190);
  data.scores = [scores](const double*) { return scores; };
  WeightedDraws draws;
  draws.values = Eigen::MatrixXd::Zero(50, 1);
  draws.weights = Eigen::VectorXd::Constant(50, 0.02);
  const Check check = fit_check(judge_fit(data, draws, {}));
  EXPECT_EQ(check.verdict, Verdict::pass) << check.detail;
  EXPECT_THAT(check.detail, HasSubstr("of 24 % of the items of each row"));
}

// 24 rows of 1000 survivors, and a row for each of the 40 000 that failed before: more rows than are judged. Of both the same share
// is judged, whatever the lots; rows drawn whole would be 12 of 24 with a standard deviation of 2.4.
TEST(FitCheck, OfManyRowsTheSameShareOfSurvivorsIsJudged) {
  FitData data;
  data.counts.assign(40'000, 1);
  data.counts.insert(data.counts.begin() + 7000, 24, 1000);
  for (std::uint64_t lot = 0; lot < 8; ++lot) {
    const std::vector<std::size_t> row = judged_items(data.counts, 20'000, Rng(3, lot));
    EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
    const auto survivors = static_cast<double>(
        std::count_if(row.begin(), row.end(), [](std::size_t i) { return i >= 7000 && i < 7024; }));
    EXPECT_NEAR(survivors, 24'000 * 20'000.0 / 40'024, 1);
    EXPECT_NEAR(static_cast<double>(row.size()) - survivors, 40'000 * 20'000.0 / 40'024, 1);
  }
  constexpr double stop = -0.3186;  // a share of 40 / 64 lies above
  Rng rng(8, 1);
  std::vector<NormalScore> scores;
  for (const int each : data.counts) {
    if (each > 1) {
      scores.push_back({-INFINITY, stop});
      continue;
    }
    double z = rng.normal();
    while (z < stop) z = rng.normal();
    scores.push_back({z, z});
  }
  data.scores = [scores](const double*) { return scores; };
  WeightedDraws draws;
  draws.values = Eigen::MatrixXd::Zero(50, 1);
  draws.weights = Eigen::VectorXd::Constant(50, 0.02);
  const Check check = fit_check(judge_fit(data, draws, {}));
  EXPECT_EQ(check.verdict, Verdict::pass) << check.detail;
  EXPECT_THAT(check.detail, HasSubstr("20000 rows, sampled from 40024"));
  data.share = 0.5;  // of a model that judges a share of its items itself
  EXPECT_NEAR(judge_fit(data, draws, {}).share, 0.5, 1e-12);
}

TEST(FitCheck, OfVeryManyRowsASampleIsJudgedAndTheOutermostOfAll) {
  Rng rng(20261125, 5);
  std::vector<double> z = normals(60'000, rng);
  const Check right = fit_check(judged(z));
  EXPECT_EQ(right.verdict, Verdict::pass) << right.detail;
  EXPECT_THAT(right.detail, HasSubstr("20000 rows, sampled from 60000"));
  for (const std::size_t row : {0u, 31'417u, 59'999u}) {
    std::vector<double> one = z;
    one[row] = -9;
    const Check far = fit_check(judged(one));
    EXPECT_EQ(far.verdict, Verdict::fail);
    EXPECT_THAT(far.detail, HasSubstr(std::to_string(row + 1) + " is an outlier"));
  }
  for (double& each : z) each *= 1.05;
  EXPECT_EQ(fit_check(judged(z)).verdict, Verdict::fail);
}

}  // namespace
}  // namespace wearwell
