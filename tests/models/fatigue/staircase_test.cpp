#include "wearwell/models/fatigue/staircase.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wearwell::fatigue {
namespace {

// By hand from Dixon and Mood's formulas: failures at 1, 2 and 3 steps, 2, 4 and 1 of them.
TEST(DixonMood, ByHand) {
  const std::vector<StairTest> tests = {{100, false, 3}, {110, true, 2},  {110, false, 4},
                                        {120, true, 4},  {120, false, 1}, {130, true, 1}};
  const DixonMood found = dixon_mood(tests);
  EXPECT_EQ(found.problem, "");
  EXPECT_TRUE(found.of_failures);
  EXPECT_EQ(found.step, 10);
  // N = 7, A = 6, B = 8: 110 + 10 (6/7 - 1/2); (7 8 - 36)/49 = 0.408.
  EXPECT_NEAR(found.mean, 110 + 10 * (6.0 / 7 - 0.5), 1e-12);
  EXPECT_NEAR(found.sd, 16.2 * (20.0 / 49 + 0.029), 1e-12);
  EXPECT_FALSE(found.crude_sd);
}

// Upside down, failures and run-outs change places and the estimate turns with them.
TEST(DixonMood, Mirrored) {
  const std::vector<StairTest> tests = {{100, false, 3}, {110, true, 2},  {110, false, 4},
                                        {120, true, 4},  {120, false, 1}, {130, true, 1}};
  std::vector<StairTest> mirrored;
  for (const StairTest& test : tests)
    mirrored.push_back({230 - test.stress, !test.failed, test.count});
  EXPECT_NEAR(dixon_mood(mirrored).mean, 230 - dixon_mood(tests).mean, 1e-12);
  EXPECT_NEAR(dixon_mood(mirrored).sd, dixon_mood(tests).sd, 1e-12);
}

TEST(DixonMood, SaysWhereItDoesNotApply) {
  EXPECT_NE(dixon_mood({{100, true, 1}, {100, false, 1}}).problem, "");
  EXPECT_NE(dixon_mood({{100, true, 1}, {110, false, 1}, {125, true, 1}}).problem, "");
  EXPECT_NE(dixon_mood({{100, true, 1}, {110, true, 1}}).problem, "");
  EXPECT_TRUE(dixon_mood({{100, false, 5}, {110, true, 5}}).crude_sd);
}

// The probabilities of both ends sum to 1, and the gradient is that of differences.
TEST(StaircaseLikelihood, IsThatOfTheLimit) {
  for (const StandardDistribution law :
       {StandardDistribution::normal, StandardDistribution::smallest_extreme_value}) {
    const double x[] = {std::log10(300e6), 0.03};
    const auto fails = staircase_likelihood(law, {{310e6, true, 1}});
    const auto holds = staircase_likelihood(law, {{310e6, false, 1}});
    EXPECT_NEAR(std::exp(fails->value(x)) + std::exp(holds->value(x)), 1, 1e-14);
    EXPECT_NEAR(std::exp(fails->value(x)), cdf(law, (std::log10(310.0 / 300)) / 0.03), 1e-12);
    const auto all = staircase_likelihood(law, {{310e6, true, 3}, {290e6, false, 2}});
    double gradient[2];
    all->value_and_gradient(x, gradient);
    for (int i = 0; i < 2; ++i) {
      double up[] = {x[0], x[1]}, down[] = {x[0], x[1]};
      up[i] += 1e-6;
      down[i] -= 1e-6;
      EXPECT_NEAR(gradient[i], (all->value(up) - all->value(down)) / 2e-6,
                  1e-5 * (1 + std::abs(gradient[i])));
    }
    const std::vector<double> terms = all->pointwise(x);
    EXPECT_NEAR(3 * terms[0] + 2 * terms[1], all->value(x), 1e-12);
  }
}

}  // namespace
}  // namespace wearwell::fatigue
