// The check of fit of a staircase: its statistic against Pearson's, what it accuses and what it does not.
#include "wearwell/models/fatigue/staircase_fit.h"

#include <gmock/gmock.h>

#include <cmath>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/mode.h"
#include "wearwell/models/fatigue/stair_scores.h"

namespace wearwell::fatigue {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const Distribution location =
    make_distribution(Normal{std::log10(300e6), 0.3}, -INFINITY, INFINITY);
const Distribution scale = make_distribution(HalfNormal{0.1}, 0, INFINITY);

WeightedDraws posterior_of(const StairFit& data) {
  const auto parameter = [](const char* name, const Distribution& prior, double start) {
    return Parameter{name, "1", Unit{"1", 1, 0}, "", prior, start, 0.1 * start};
  };
  const Posterior posterior({parameter("log10_limit", data.log10_limit, std::log10(300e6)),
                             parameter("sigma_limit", data.sigma_limit, 0.03)},
                            staircase_likelihood(data.limit, data.tests));
  return integrate(posterior, whitening_at(find_mode(posterior, posterior.start()))).nodes;
}

StairFit fit_of(const std::vector<StairTest>& tests) {
  return {StandardDistribution::normal, tests, location, scale, Unit{"MPa", 1e6, 0}};
}

Check check(const std::vector<StairTest>& tests) {
  const StairFit data = fit_of(tests);
  return staircase_fit_check(data, posterior_of(data));
}

// Up and down about limits that are drawn: `log10_limit` of each item in turn, in steps of `step`.
template <class Draw>
std::vector<StairTest> up_and_down(int count, double start, double step, const Draw& log10_limit) {
  std::vector<StairTest> tests;
  double at = start;
  for (int i = 0; i < count; ++i) {
    const bool failed = at > log10_limit(i);
    tests.push_back({std::pow(10, at), failed, 1});
    at += failed ? -step : step;
  }
  return tests;
}

const double middle = std::log10(300e6);

// Where a cubic in w passes through all levels, the score test at the maximum of the likelihood is Pearson's test:
// 4 levels, 2 parameters, 2 degrees of freedom.
TEST(StairScores, OfFourLevelsArePearsonsChiSquared) {
  const std::vector<double> stress = {270e6, 290e6, 310e6, 330e6}, failures = {3, 4, 11, 14};
  constexpr double tests = 20;
  std::vector<StairTest> rows;
  for (std::size_t l = 0; l < 4; ++l) {
    rows.push_back({stress[l], true, static_cast<int>(failures[l])});
    rows.push_back({stress[l], false, static_cast<int>(tests - failures[l])});
  }
  const auto likelihood = staircase_likelihood(StandardDistribution::normal, rows);
  // By differences of the likelihood: Newton's steps on (location, log scale).
  double x[] = {middle, 0.05};
  for (int i = 0; i < 200; ++i) {
    double gradient[2], moved[2][2];
    likelihood->value_and_gradient(x, gradient);
    constexpr double h = 1e-6;
    for (int j = 0; j < 2; ++j) {
      double y[] = {x[0], x[1]};
      y[j] += h;
      likelihood->value_and_gradient(y, moved[j]);
    }
    const double a = (moved[0][0] - gradient[0]) / h, b = (moved[0][1] - gradient[1]) / h,
                 d = (moved[1][1] - gradient[1]) / h, det = a * d - b * b;
    x[0] -= (d * gradient[0] - b * gradient[1]) / det;
    x[1] -= (a * gradient[1] - b * gradient[0]) / det;
  }
  double pearson = 0;
  for (std::size_t l = 0; l < 4; ++l) {
    const double p = cdf(StandardDistribution::normal, (std::log10(stress[l]) - x[0]) / x[1]);
    pearson += std::pow(failures[l] - tests * p, 2) / (tests * p * (1 - p));
  }
  const StairDesign design = stair_design(rows);
  EXPECT_FALSE(design.up_and_down);
  const StairScores scores =
      stair_scores(design, design.observed, StandardDistribution::normal, x[0], x[1]);
  EXPECT_GT(pearson, 0.5);
  EXPECT_NEAR(scores.shape(), pearson, 1e-5 * pearson);
  EXPECT_EQ(scores.later, 0);
}

// Score and information of `later` are those of a limit that moves by so much from test to test: by differences.
TEST(StairScores, LaterIsTheScoreOfALimitThatMoves) {
  const StairDesign design = stair_design(up_and_down(
      12, middle + 0.02, 0.02, [](int i) { return middle + 0.02 * std::sin(7.0 * i); }));
  ASSERT_TRUE(design.up_and_down);
  const StairOutcomes& seen = design.observed;
  const auto terms = [&](const Eigen::Vector3d& change) {
    std::vector<double> log_p;
    for (std::size_t i = 0; i < seen.level.size(); ++i) {
      const double w = (design.log10_stress[seen.level[i]] - middle) / 0.03;
      const double moved = w + change[0] + change[1] * w + change[2] * static_cast<double>(i + 1);
      log_p.push_back(seen.failures[i] > 0 ? log_cdf(StandardDistribution::normal, moved)
                                           : log_survival(StandardDistribution::normal, moved));
    }
    return log_p;
  };
  constexpr double h = 1e-5;
  Eigen::Vector3d score = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < seen.level.size(); ++i) {
    const double w = (design.log10_stress[seen.level[i]] - middle) / 0.03;
    const double p = cdf(StandardDistribution::normal, w),
                 density = std::exp(-w * w / 2) / std::sqrt(2 * M_PI);
    const Eigen::Vector3d direction(1, w, static_cast<double>(i + 1));
    information += density * density / (p * (1 - p)) * direction * direction.transpose();
  }
  for (int k = 0; k < 3; ++k) {
    const std::vector<double> up = terms(h * Eigen::Vector3d::Unit(k)),
                              down = terms(-h * Eigen::Vector3d::Unit(k));
    for (std::size_t i = 0; i < up.size(); ++i) score[k] += (up[i] - down[i]) / (2 * h);
  }
  const Eigen::Vector2d part =
      information.topLeftCorner<2, 2>().ldlt().solve(information.topRightCorner<2, 1>());
  const double left = information(2, 2) - information.topRightCorner<2, 1>().dot(part);
  const double expected = (score[2] - part.dot(score.head<2>())) / std::sqrt(left);
  const StairScores scores = stair_scores(design, seen, StandardDistribution::normal, middle, 0.03);
  EXPECT_NEAR(scores.later, expected, 1e-6);
}

TEST(StairDesign, KnowsWhatGoesUpAndDown) {
  const auto tests = up_and_down(10, middle, 0.02, [](int) { return middle - 0.01; });
  EXPECT_TRUE(stair_design(tests).up_and_down);
  std::vector<StairTest> sorted = tests;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const StairTest& a, const StairTest& b) { return a.failed < b.failed; });
  EXPECT_FALSE(stair_design(sorted).up_and_down);
  std::vector<StairTest> counted = tests;
  counted[3].count = 2;
  EXPECT_FALSE(stair_design(counted).up_and_down);
}

// Each step of a simulated sequence goes down after a failure and up after a survivor, and stresses are those of the ladder.
TEST(StairDesign, SimulatesByTheSameRule) {
  const StairDesign design = stair_design(
      up_and_down(30, middle, 0.02, [](int i) { return middle + (i % 3 - 1) * 0.03; }));
  Rng rng(1, 1);
  const StairOutcomes drawn = design.simulate(StandardDistribution::normal, middle, 0.03, rng);
  for (std::size_t i = 0; i + 1 < drawn.level.size(); ++i) {
    EXPECT_NEAR(design.log10_stress[drawn.level[i + 1]] - design.log10_stress[drawn.level[i]],
                drawn.failures[i] > 0 ? -0.02 : 0.02, 1e-9);
  }
}

// A level of so many tests fails as often as its probability says, drawn one by one or by quantiles.
TEST(StairDesign, SimulatesLevelsOfManyTests) {
  const StairDesign design =
      stair_design({{290e6, true, 3}, {290e6, false, 9}, {310e6, true, 300}, {310e6, false, 100}});
  ASSERT_THAT(design.observed.tests, ElementsAre(12, 400));
  ASSERT_THAT(design.observed.failures, ElementsAre(3, 300));
  Rng rng(1, 1);
  constexpr int times = 4000;
  std::vector<double> sum(2), squares(2);
  for (int i = 0; i < times; ++i) {
    const StairOutcomes drawn = design.simulate(StandardDistribution::normal, middle, 0.03, rng);
    for (std::size_t l = 0; l < 2; ++l) {
      sum[l] += drawn.failures[l];
      squares[l] += drawn.failures[l] * drawn.failures[l];
    }
  }
  for (std::size_t l = 0; l < 2; ++l) {
    const double n = design.observed.tests[l],
                 p = cdf(StandardDistribution::normal, (design.log10_stress[l] - middle) / 0.03),
                 variance = n * p * (1 - p), mean = sum[l] / times;
    EXPECT_NEAR(mean, n * p, 5 * std::sqrt(variance / times));
    EXPECT_NEAR(squares[l] / times - mean * mean, variance, 0.15 * variance);
  }
}

TEST(StaircaseFit, PassesARightSequenceThatRepeatsItself) {
  Rng rng(3, 0);
  const auto tests =
      up_and_down(30, middle, 0.03, [&](int) { return middle + 0.03 * rng.normal(); });
  const Check found = check(tests);
  EXPECT_EQ(found.name, "fit");
  EXPECT_EQ(found.verdict, Verdict::pass) << found.detail;
  EXPECT_THAT(found.detail, HasSubstr("of 2 tests"));
}

TEST(StaircaseFit, SeesALimitThatDrifts) {
  Rng rng(3, 0);
  const auto drifting = [&](double by) {
    return check(up_and_down(40, middle, 0.02, [&](int i) {
      return middle + by * (i - 20) / 20 + 0.01 * rng.normal();
    }));
  };
  const Check falls = drifting(-0.1), rises = drifting(0.1);
  EXPECT_EQ(falls.verdict, Verdict::fail) << falls.detail;
  EXPECT_THAT(falls.detail, HasSubstr("specimens bear less the later they were tested"));
  EXPECT_EQ(rises.verdict, Verdict::fail) << rises.detail;
  EXPECT_THAT(rises.detail, HasSubstr("specimens bear more the later they were tested"));
  EXPECT_THAT(rises.advice, HasSubstr("load cell"));
}

// Two thirds of the specimens fail at any of these stresses and one third at none: the share does not grow with stress.
TEST(StaircaseFit, SeesSpecimensOfTwoKinds) {
  std::vector<StairTest> tests;
  for (const double stress : {260e6, 280e6, 300e6, 320e6, 340e6}) {
    tests.push_back({stress, true, stress < 270e6 ? 1 : 20});
    tests.push_back({stress, false, stress < 270e6 ? 29 : 10});
  }
  const Check found = check(tests);
  EXPECT_EQ(found.verdict, Verdict::fail) << found.detail;
  EXPECT_THAT(found.detail, HasSubstr("failures do not follow the distribution of the limit: at"));
  EXPECT_THAT(found.detail, HasSubstr("of 30 tests failed, where"));
}

// Sorted by outcome, the rows say nothing of the order of the tests.
TEST(StaircaseFit, AccusesNoTableThatIsSortedByOutcome) {
  Rng rng(5, 0);
  std::vector<StairTest> tests =
      up_and_down(40, middle, 0.02, [&](int) { return middle + 0.02 * rng.normal(); });
  for (const bool failures_first : {true, false}) {
    std::stable_sort(tests.begin(), tests.end(), [&](const StairTest& a, const StairTest& b) {
      return failures_first ? a.failed > b.failed : a.failed < b.failed;
    });
    const Check found = check(tests);
    EXPECT_EQ(found.verdict, Verdict::pass) << found.detail;
    EXPECT_THAT(found.detail, HasSubstr("of 1 test of the outcomes"));
  }
}

TEST(StaircaseFit, SaysWhereThereIsNothingToJudge) {
  const Check found =
      check({{290e6, true, 3}, {290e6, false, 7}, {310e6, true, 8}, {310e6, false, 2}});
  EXPECT_EQ(found.verdict, Verdict::pass);
  EXPECT_THAT(found.detail, HasSubstr("fewer than three stresses"));
  EXPECT_EQ(check({{290e6, true, 3}}).verdict, Verdict::pass);
}

}  // namespace
}  // namespace wearwell::fatigue
