#include "wearwell/infer/constrained_mode.h"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "infer/test_posteriors.h"
#include "support/formula.h"
#include "wearwell/models/fatigue/sn_likelihood.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

NaturalMode mode_of(const Posterior& posterior) {
  FitSettings settings;
  settings.run.warmup = 300;
  settings.run.draws = 100;
  return constrained_mode(posterior, fit(posterior, settings));
}

Parameter of_law(const std::string& name, const Family& family, double lower, double upper,
                 double start) {
  return {name, "1", Unit{"1", 1, 0}, "test", make_distribution(family, lower, upper), start, 1};
}

Posterior prior_only(const Parameter& parameter) {
  return {{parameter}, std::make_shared<Formula>(1, [](auto, std::span<double> gradient) {
            gradient[0] = 0;
            return 0.0;
          })};
}

// A normal density of unit variances, correlation 0.8, centered at (1, 2).
Posterior two_normals(double upper_of_second) {
  constexpr double correlation = 0.8;
  return {{of_law("a", Flat{}, -INFINITY, INFINITY, 0.5),
           of_law("b", Uniform{}, -10, upper_of_second, 0)},
          std::make_shared<Formula>(2, [](std::span<const double> x, std::span<double> gradient) {
            const double a = x[0] - 1, b = x[1] - 2, scale = 1 / (1 - correlation * correlation);
            gradient[0] = -scale * (a - correlation * b);
            gradient[1] = -scale * (b - correlation * a);
            return 0.5 * (gradient[0] * a + gradient[1] * b);
          })};
}

TEST(NaturalMode, OfANormalIsItsMeanAndItsErrorsAreItsStandardDeviations) {
  const NaturalMode mode = mode_of(two_normals(10));
  ASSERT_EQ(mode.problem, "");
  EXPECT_NEAR(mode.position[0], 1, 1e-7);
  EXPECT_NEAR(mode.position[1], 2, 1e-7);
  EXPECT_NEAR(mode.standard_error[0], 1, 1e-6);
  EXPECT_NEAR(mode.standard_error[1], 1, 1e-6);
  EXPECT_NEAR(mode.log_likelihood, 0, 1e-12);
  EXPECT_NEAR(mode.log_posterior, -std::log(20), 1e-12);  // the uniform prior's density
  EXPECT_TRUE(mode.maximum);
  EXPECT_EQ(mode.reached, mode.starts);
  EXPECT_GE(mode.starts, 10);
}

// The conditional normal: mean 1 + 0.8 (1 - 2), variance 1 - 0.64.
TEST(NaturalMode, OnABoundTheOthersAreConditional) {
  const NaturalMode mode = mode_of(two_normals(1));
  ASSERT_EQ(mode.problem, "");
  EXPECT_EQ(mode.place[1], Place::upper_bound);
  EXPECT_EQ(mode.position[1], 1);
  EXPECT_TRUE(std::isnan(mode.standard_error[1]));
  EXPECT_EQ(mode.place[0], Place::inside);
  EXPECT_NEAR(mode.position[0], 0.2, 1e-6);
  EXPECT_NEAR(mode.standard_error[0], 0.6, 1e-6);
}

// In its own units the gamma law of shape 2 and scale 3 is highest at 3, curvature 1/9; its
// logarithm is highest at 6.
TEST(NaturalMode, HasNoJacobian) {
  const NaturalMode mode = mode_of(prior_only(of_law("x", Gamma{2, 3}, 0, INFINITY, 4)));
  ASSERT_EQ(mode.problem, "");
  EXPECT_NEAR(mode.position[0], 3, 1e-6);
  EXPECT_NEAR(mode.standard_error[0], 3, 1e-5);
  EXPECT_FALSE(mode.maximum);
}

TEST(NaturalMode, SaysWhyThereIsNone) {
  EXPECT_THAT(mode_of(prior_only(of_law("x", Gamma{0.5, 3}, 0, INFINITY, 1))).problem,
              HasSubstr("is unbounded as x approaches its lower bound"));
  const Posterior rising(
      {of_law("x", Normal{0, 1}, -INFINITY, INFINITY, 0.1), of_law("y", Flat{}, 0, INFINITY, 1)},
      std::make_shared<Formula>(2, [](std::span<const double> x, std::span<double> gradient) {
        gradient[0] = 0;
        gradient[1] = std::exp(-x[1]);
        return -gradient[1];
      }));
  EXPECT_THAT(mode_of(rising).problem, HasSubstr("y"));
}

// tests/golden/sn_mode.R: the same tests, by R.
TEST(NaturalMode, MaximumLikelihoodOfLifeTestsWithRunouts) {
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/sn_mode.csv");
  fatigue::LifeTests tests;
  int compared = 0;
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (cells[0] == "test") {
      tests.push_back({{std::stod(cells[1]), 0},
                       cells[3] == "1" ? fatigue::Outcome::failure : fatigue::Outcome::runout,
                       std::stod(cells[2]),
                       0,
                       1});
    }
    if (cells[0] != "normal" && cells[0] != "weibull") continue;
    fatigue::SnLaw law;
    law.correction = fatigue::MeanStress::none;
    if (cells[0] == "weibull") law.family = fatigue::LifeFamily::weibull;
    const Posterior posterior(
        {of_law("log10_a", Flat{}, -INFINITY, INFINITY, 9.2),
         of_law("b", Flat{}, -INFINITY, 0, -0.1), of_law("sigma", Flat{}, 0, INFINITY, 0.2)},
        fatigue::sn_likelihood(law, tests, tests.size()));
    const NaturalMode mode = mode_of(posterior);
    ASSERT_EQ(mode.problem, "") << line;
    EXPECT_TRUE(mode.maximum);
    EXPECT_GE(mode.reached,
              10);  // flat priors leave the posterior improper, and some draws far off
    for (int i = 0; i < 3; ++i) {
      const double value = std::stod(cells[static_cast<std::size_t>(1 + i)]),
                   error = std::stod(cells[static_cast<std::size_t>(4 + i)]);
      EXPECT_NEAR(mode.position[i], value, 2e-5 * error) << line;
      EXPECT_NEAR(mode.standard_error[i], error, 2e-5 * error) << line;
    }
    EXPECT_NEAR(mode.log_likelihood, std::stod(cells[7]), 1e-8) << line;
    ++compared;
  }
  EXPECT_EQ(tests.size(), 24u);
  EXPECT_EQ(compared, 2);
}

// Wear rates of 1e-13 are found as well as lengths of 1: the least squares estimate of k = sum(W V)/sum(W^2)
// and sigma^2 = residual sum of squares / n.
TEST(NaturalMode, OfTheJointIsLeastSquares) {
  const NaturalMode mode = mode_of(joint_posterior(false, false, 15, 5));
  ASSERT_EQ(mode.problem, "");
  double wv = 0, ww = 0, rss = 0;
  const double cycles[] = {1, 100, 1000, 5000, 10000},
               volume[] = {4.44, 5.105, 8.825, 24.175, 45.31};
  for (int i = 0; i < 5; ++i) {
    wv += 5.966 * cycles[i] * volume[i];
    ww += std::pow(5.966 * cycles[i], 2);
  }
  const double k = wv / ww;
  for (int i = 0; i < 5; ++i) rss += std::pow(volume[i] - k * 5.966 * cycles[i], 2);
  const double sigma = std::sqrt(rss / 5);
  EXPECT_NEAR(mode.position[0] * 1e9 / k, 1, 1e-8);
  EXPECT_NEAR(mode.position[1] * 1e9 / sigma, 1, 1e-8);
  EXPECT_NEAR(mode.standard_error[0] * 1e9 / (sigma / std::sqrt(ww)), 1, 1e-6);
  EXPECT_NEAR(mode.standard_error[1] * 1e9 / (sigma / std::sqrt(10)), 1, 1e-6);
}

}  // namespace
}  // namespace wearwell
