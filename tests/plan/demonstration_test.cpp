#include "wearwell/plan/demonstration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/golden.h"
#include "wearwell/base/rng.h"
#include "wearwell/plan/planning_value.h"

namespace wearwell::plan {
namespace {

using enum StandardDistribution;

Scatter weibull_scatter(double shape) {
  return {smallest_extreme_value, {{1 / shape, 1}}};
}

// The prior of tests/golden/demonstration.R: 90 % interval 1.5 to 3 of a lognormal distribution.
Scatter prior_scatter() {
  const PlanningValue shape = read_planning_value("--shape", "1.5 to 3");
  Scatter scatter;
  for (const NormalNode& node : normal_nodes(48))
    scatter.scales.push_back({1 / shape.at(node.z), node.weight});
  return scatter;
}

// Success-run table, printed in many books: O'Connor and Kleyner, Practical Reliability Engineering (2012), ch. 14; n = ln(1 -
// C)/ln R, rounded up.
TEST(LeastSpecimens, AreThoseOfTheSuccessRunTable) {
  const double reliabilities[] = {0.8, 0.85, 0.9, 0.95, 0.99, 0.995, 0.999};
  const double confidences[] = {0.8, 0.9, 0.95, 0.99};
  const std::size_t table[7][4] = {
      {8, 11, 14, 21},      {10, 15, 19, 29},     {16, 22, 29, 44},        {32, 45, 59, 90},
      {161, 230, 299, 459}, {322, 460, 598, 919}, {1609, 2302, 2995, 4603}};
  for (int r = 0; r < 7; ++r)
    for (int c = 0; c < 4; ++c)
      EXPECT_EQ(least_specimens(0, 1, {}, 1 - reliabilities[r], confidences[c]), table[r][c])
          << reliabilities[r] << " " << confidences[c];
}

// 90/90, 95/90 and 95/95 with 0 to 3 failures (MIL-HDBK-781A's binomial plans, and any table of them).
TEST(LeastSpecimens, AreThoseOfBinomialTables) {
  const std::size_t table[3][4] = {{22, 38, 52, 65}, {45, 77, 105, 132}, {59, 93, 124, 153}};
  const double reliability[] = {0.9, 0.95, 0.95}, confidence[] = {0.9, 0.9, 0.95};
  for (int i = 0; i < 3; ++i)
    for (std::size_t f = 0; f < 4; ++f)
      EXPECT_EQ(least_specimens(f, 1, {}, 1 - reliability[i], confidence[i]), table[i][f]);
}

// (1 - C) = R^n exactly: rounding must not add a specimen.
TEST(LeastSpecimens, CountsAnExactSolution) {
  EXPECT_EQ(least_specimens(0, 1, {}, 0.5, 0.75), 2U);
  EXPECT_EQ(least_specimens(0, 1, {}, 0.1, 1 - std::pow(0.9, 30)), 30U);
}

TEST(Demonstration, IsThatOfR) {
  const Scatter prior = prior_scatter();
  int checked = 0;
  for (const auto& row : read_golden("demonstration.csv")) {
    const std::string& what = row[0];
    const double failing = 1 - std::stod(row[1]), confidence = std::stod(row[2]),
                 spread = std::stod(row[5]), time = std::stod(row[6]), value = std::stod(row[7]);
    const std::size_t allowed = std::stoul(row[3]), n = std::stoul(row[4]);
    const std::string where = ::testing::PrintToString(row);
    ++checked;
    if (what == "specimens") {
      EXPECT_EQ(least_specimens(allowed, 1, {}, failing, confidence), std::stoul(row[7])) << where;
    } else if (what == "time") {
      const auto found = least_time(n, allowed, weibull_scatter(spread), failing, confidence);
      ASSERT_TRUE(found) << where;
      EXPECT_NEAR(*found / value, 1, 1e-9) << where;
    } else if (what == "weibull") {
      EXPECT_EQ(least_specimens(allowed, time, weibull_scatter(spread), failing, confidence),
                std::stoul(row[7]))
          << where;
    } else if (what == "lognormal") {
      EXPECT_EQ(least_specimens(allowed, time, {normal, {{spread, 1}}}, failing, confidence),
                std::stoul(row[7]))
          << where;
    } else if (what == "exposure") {
      EXPECT_NEAR(required_exposure(allowed, failing, confidence) / value, 1, 1e-12) << where;
    } else if (what == "sudden") {
      EXPECT_NEAR(pass_probability(sudden_death_test(n, 5, spread, failing, confidence), spread,
                                   failing, time),
                  value, 1e-12)
          << where;
    } else if (what == "averaged") {
      EXPECT_NEAR(demonstrated_confidence({n, allowed, time}, prior, failing), value, 1e-9)
          << where;
    } else if (what == "posterior") {
      EXPECT_NEAR(posterior_after_success(n, time, prior, failing), value, 1e-9) << where;
    } else {
      ADD_FAILURE() << "unknown row " << where;
    }
  }
  EXPECT_GT(checked, 250);
}

// Abernethy, The New Weibull Handbook, ch. 6: the multiplier of the characteristic life of a zero-failure plan, m = (-ln(1 - C)
// / n)^(1/shape). His table at 90 %: n = 3, shape 0.5 to 5: 0.589, 0.767, 0.838, 0.876, 0.916, 0.948. The share 1 - 1/e fails
// by the characteristic life.
TEST(LeastTime, IsThatOfTheWeibullHandbook) {
  const double failing = -std::expm1(-1.0);
  const double shapes[] = {0.5, 1, 1.5, 2, 3, 5},
               table[] = {0.589, 0.767, 0.838, 0.876, 0.916, 0.948};
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(*least_time(3, 0, weibull_scatter(shapes[i]), failing, 0.9), table[i], 1e-3)
        << shapes[i];
  // The handbook's turbopump example: 3 units, shape 2, 500 h at 90 %: 438 h.
  EXPECT_NEAR(500 * *least_time(3, 0, weibull_scatter(2), failing, 0.9), 438, 0.5);
}

// Without failures the number of specimens is k / (time^shape), k = ln(1 - C)/ln R: Meeker and Escobar, Statistical Methods for
// Reliability Data, minimum sample size demonstration.
TEST(LeastSpecimens, FollowTheFormulaOfMeekerAndEscobar) {
  for (const double shape : {0.7, 1.0, 2.0, 3.5})
    for (const double time : {0.6, 1.0, 1.7, 3.0})
      for (const double failing : {0.01, 0.05, 0.1})
        for (const double confidence : {0.8, 0.9, 0.99}) {
          const double n = std::log1p(-confidence) / std::log1p(-failing) / std::pow(time, shape);
          EXPECT_EQ(*least_specimens(0, time, weibull_scatter(shape), failing, confidence),
                    static_cast<std::size_t>(std::ceil(n * (1 - 1e-12))))
              << shape << " " << time;
        }
}

// The median rank of the first failure of a group of k, 1 - 0.5^(1/k): Johnson's tables (1964), 12.94 % of 5, 8.30 % of 8, 6.70
// % of 10.
TEST(SuddenDeath, HasTheMedianRanksOfJohnson) {
  EXPECT_NEAR(sudden_death_test(6, 4, 2, 0.1, 0.9).first_failure_share, 0.1591, 5e-5);
  EXPECT_NEAR(sudden_death_test(6, 5, 2, 0.1, 0.9).first_failure_share, 0.1294, 5e-5);
  EXPECT_NEAR(sudden_death_test(6, 8, 2, 0.1, 0.9).first_failure_share, 0.0830, 5e-5);
  EXPECT_NEAR(sudden_death_test(6, 10, 2, 0.1, 0.9).first_failure_share, 0.0670, 5e-5);
  // and is the share that fails by the median first failure
  EXPECT_NEAR(
      failing_by(smallest_extreme_value, 1 / 1.7, 0.1, median_first_failure(5, 1.7, 0.1, 1)),
      0.1294, 5e-5);
}

// The rule as a test rig runs it: groups of Weibull lives, stopped by their first failure.
TEST(SuddenDeath, PassesAsOftenAsInSimulation) {
  constexpr std::size_t groups = 4, size = 5;
  constexpr double shape = 1.7, failing = 0.1;
  const SuddenDeathTest test = sudden_death_test(groups, size, shape, failing, 0.9);
  for (const double life : {1.0, 1.5, 2.5}) {
    Rng random(1, static_cast<std::uint64_t>(10 * life));
    constexpr int runs = 40000;
    int passed = 0;
    for (int run = 0; run < runs; ++run) {
      double exposure = 0;
      for (std::size_t g = 0; g < groups; ++g) {
        double first = 1e300;
        for (std::size_t i = 0; i < size; ++i)
          first = std::min(
              first, life * std::pow(std::log(random.uniform()) / std::log1p(-failing), 1 / shape));
        exposure += size * std::pow(first, shape);
      }
      passed += exposure >= test.exposure;
    }
    const double p = pass_probability(test, shape, failing, life);
    EXPECT_NEAR(passed / static_cast<double>(runs), p, 4 * std::sqrt(p * (1 - p) / runs)) << life;
  }
  EXPECT_NEAR(pass_probability(test, shape, failing, 1), 0.1, 1e-12);
}

TEST(PassProbability, IsThatOfSimulation) {
  const Scatter scatter = {normal, {{0.5, 1}}};
  constexpr std::size_t n = 12;
  Rng random(2, 1);
  constexpr int runs = 40000;
  int passed = 0;
  const double median = 1.4 * std::exp(0.5 * 1.2815515655446004);  // B10 is 1.4
  for (int run = 0; run < runs; ++run) {
    int failed = 0;
    for (std::size_t i = 0; i < n; ++i) failed += median * std::exp(0.5 * random.normal()) <= 1.2;
    passed += failed <= 1;
  }
  const double p = pass_probability({n, 1, 1.2}, scatter, 0.1, 1.4);
  EXPECT_NEAR(passed / static_cast<double>(runs), p, 4 * std::sqrt(p * (1 - p) / runs));
}

TEST(PassProbability, GrowsWithLifeAndFailuresAndFallsWithSpecimensAndTime) {
  const Scatter scatter = prior_scatter();
  const auto p = [&](std::size_t n, std::size_t f, double time, double life) {
    return pass_probability({n, f, time}, scatter, 0.1, life);
  };
  EXPECT_LT(p(10, 0, 1.5, 1), p(10, 0, 1.5, 2));
  EXPECT_LT(p(10, 0, 1.5, 1), p(10, 1, 1.5, 1));
  EXPECT_GT(p(10, 0, 1.5, 1), p(11, 0, 1.5, 1));
  EXPECT_GT(p(10, 0, 1.5, 1), p(10, 0, 1.6, 1));
}

// With a shape that is known the flat prior gives the confidence itself.
TEST(Posterior, IsTheConfidenceForAKnownShape) {
  for (const double time : {0.5, 1.0, 2.0})
    EXPECT_NEAR(posterior_after_success(9, time, weibull_scatter(2), 0.1),
                demonstrated_confidence({9, 0, time}, weibull_scatter(2), 0.1), 1e-12);
}

TEST(LeastTime, IsNoneWithoutMoreSpecimensThanFailures) {
  EXPECT_FALSE(least_time(2, 2, weibull_scatter(2), 0.1, 0.9));
  EXPECT_FALSE(least_time(5, 0, {}, 0.1, 0.9));
}

}  // namespace
}  // namespace wearwell::plan
