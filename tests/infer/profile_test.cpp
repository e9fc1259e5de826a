// Profile-likelihood intervals against what regression has in closed form, and against brute force.
#include "wearwell/infer/profile.h"

#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <sstream>

#include "infer/test_posteriors.h"
#include "support/formula.h"
#include "wearwell/models/fatigue/sn_likelihood.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

constexpr double level = 0.9, z = 1.6448536269514722;  // the normal law's 95 % quantile

Fit short_fit(const Posterior& posterior) {
  FitSettings settings;
  settings.run.warmup = 300;
  settings.run.draws = 100;
  return fit(posterior, settings);
}

// The line through the origin of joint_posterior: k sum(W^2) = sum(W V); in mm^3, N and m.
struct Line {
  double k = 0, ww = 0, rss = 0;
  int n = 5;

  Line() {
    const double cycles[] = {1, 100, 1000, 5000, 10000},
                 volume[] = {4.44, 5.105, 8.825, 24.175, 45.31};
    double wv = 0;
    for (int i = 0; i < n; ++i) {
      wv += 5.966 * cycles[i] * volume[i];
      ww += std::pow(5.966 * cycles[i], 2);
    }
    k = wv / ww;
    for (int i = 0; i < n; ++i) rss += std::pow(volume[i] - k * 5.966 * cycles[i], 2);
  }
  double sigma() const { return std::sqrt(rss / n); }
  // Twice the fall of the log-likelihood from its maximum, sigma held and k at its best.
  double deviance(double s) const { return 2 * n * std::log(s / sigma()) + rss / (s * s) - n; }
};

// The residual sum of squares is rss + ww (k - k_hat)^2, and the best sigma follows it.
TEST(Profile, OfALinesSlopeAndScatterIsInClosedForm) {
  const Posterior posterior = joint_posterior(false, false, 500, 5);
  const Fit fit = short_fit(posterior);
  const NaturalMode mode = constrained_mode(posterior, fit);
  ASSERT_EQ(mode.problem, "");
  const auto intervals = profile_intervals(posterior, fit, mode, level);
  const Line line;
  const double reach = std::sqrt(line.rss / line.ww * std::expm1(z * z / line.n));
  EXPECT_EQ(intervals[0].lower.open, "");
  EXPECT_NEAR(intervals[0].lower.value * 1e9 / (line.k - reach), 1, 1e-6);
  EXPECT_NEAR(intervals[0].upper.value * 1e9 / (line.k + reach), 1, 1e-6);
  EXPECT_LT(intervals[1].lower.value * 1e9, line.sigma());
  EXPECT_GT(intervals[1].upper.value * 1e9, line.sigma());
  EXPECT_NEAR(line.deviance(intervals[1].lower.value * 1e9), z * z, 1e-5);
  EXPECT_NEAR(line.deviance(intervals[1].upper.value * 1e9), z * z, 1e-5);
}

TEST(Profile, AnEndBeyondTheBoundIsOpenAndSaysSo) {
  const double bound = 1.2 * Line().sigma();
  const Posterior posterior = joint_posterior(false, false, bound, 5);
  const Fit fit = short_fit(posterior);
  const NaturalMode mode = constrained_mode(posterior, fit);
  ASSERT_EQ(mode.problem, "");
  const ProfileInterval sigma = profile_intervals(posterior, fit, mode, level)[1];
  EXPECT_EQ(sigma.lower.open, "");
  EXPECT_TRUE(std::isnan(sigma.upper.value));
  EXPECT_THAT(sigma.upper.open, HasSubstr("up to the bound"));
}

// Two normals of unit variance and correlation 0.8 about (1, 2), the second at most 1: its profile is
// -(b - 2)^2/2, which at the bound is 1/2 below its summit.
TEST(Profile, OfAModeOnItsBoundIsOpenThere) {
  constexpr double correlation = 0.8;
  const Posterior posterior(
      {{"a", "1", Unit{"1", 1, 0}, "flat", make_distribution(Flat{}, -INFINITY, INFINITY), 0.5, 1},
       {"b", "1", Unit{"1", 1, 0}, "uniform", make_distribution(Uniform{}, -10, 1), 0, 1}},
      std::make_shared<Formula>(2, [](std::span<const double> x, std::span<double> gradient) {
        const double a = x[0] - 1, b = x[1] - 2, scale = 1 / (1 - correlation * correlation);
        gradient[0] = -scale * (a - correlation * b);
        gradient[1] = -scale * (b - correlation * a);
        return 0.5 * (gradient[0] * a + gradient[1] * b);
      }));
  const Fit fit = short_fit(posterior);
  const NaturalMode mode = constrained_mode(posterior, fit);
  ASSERT_EQ(mode.problem, "");
  const ProfileInterval b = profile_intervals(posterior, fit, mode, level)[1];
  EXPECT_THAT(b.upper.open, HasSubstr("the mode is at the bound"));
  EXPECT_EQ(b.lower.open, "");
  EXPECT_NEAR(b.lower.value, 2 - std::sqrt(1 + z * z), 1e-6);
}

// tests/golden/sn_profile.py: the same 24 tests with run-outs, by brute force.
TEST(Profile, OfLifeTestsWithRunoutsAsBruteForceFindsIt) {
  fatigue::LifeTests tests;
  std::ifstream data(PROJECT_SOURCE_DIR "/tests/golden/sn_mode.csv"),
      golden(PROJECT_SOURCE_DIR "/tests/golden/sn_profile.csv");
  const auto cells = [](const std::string& line) {
    std::vector<std::string> all;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) all.push_back(cell);
    return all;
  };
  for (std::string line; std::getline(data, line);) {
    const auto c = cells(line);
    if (c[0] != "test") continue;
    tests.push_back({{std::stod(c[1]), 0},
                     c[3] == "1" ? fatigue::Outcome::failure : fatigue::Outcome::runout,
                     std::stod(c[2]),
                     0,
                     1});
  }
  std::map<std::string, std::map<std::string, std::vector<double>>> expected;
  for (std::string line; std::getline(golden, line);) {
    const auto c = cells(line);
    if (c[0] != "family") {
      expected[c[0]][c[1]] = {std::stod(c[2]), std::stod(c[3]), std::stod(c[4])};
    }
  }
  ASSERT_EQ(expected.size(), 2u);
  for (auto& [family, numbers] : expected) {
    fatigue::SnLaw law;
    law.correction = fatigue::MeanStress::none;
    if (family == "weibull") law.family = fatigue::LifeFamily::weibull;
    const auto flat = [](const std::string& name, double lower, double upper, double start) {
      return Parameter{name,  "1", Unit{"1", 1, 0}, "flat", make_distribution(Flat{}, lower, upper),
                       start, 1};
    };
    const Posterior posterior({flat("log10_a", -INFINITY, INFINITY, 9.2),
                               flat("b", -INFINITY, 0, -0.1), flat("sigma", 0, INFINITY, 0.2)},
                              fatigue::sn_likelihood(law, tests, tests.size()));
    const Fit fit = short_fit(posterior);
    const NaturalMode mode = constrained_mode(posterior, fit);
    ASSERT_EQ(mode.problem, "");
    const auto intervals = profile_intervals(posterior, fit, mode, level);
    const auto compare = [](const ProfileInterval& interval, const std::vector<double>& ends) {
      EXPECT_NEAR(interval.lower.value, ends[1], 1e-5 * (ends[2] - ends[1]));
      EXPECT_NEAR(interval.upper.value, ends[2], 1e-5 * (ends[2] - ends[1]));
    };
    compare(intervals[0], numbers.at("log10_a"));
    compare(intervals[1], numbers.at("b"));
    compare(intervals[2], numbers.at("sigma"));
    const double log10_stress = std::log10(380e6), below = quantile(law.standard(), 0.1);
    const ProfiledQuantity b10{
        0, [=](const double* x) { return (log10_stress - x[0]) / x[1] + below * x[2]; },
        [=](const double* x, double life) { return log10_stress - x[1] * (life - below * x[2]); }};
    EXPECT_NEAR(b10.value(mode.position.data()), numbers.at("log10 B10 at 380 MPa")[0], 1e-6);
    compare(profile_interval(posterior, fit, mode, b10, level), numbers.at("log10 B10 at 380 MPa"));
  }
}

}  // namespace
}  // namespace wearwell
