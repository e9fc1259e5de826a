#include "wearwell/models/recurrence/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "wearwell/math/quantile.h"

namespace wearwell::recurrence {
namespace {

// Crow's example (2004): first occurrences and numbers of failures of 16 modes with a delayed fix, and the effectiveness.
GrowthTest delayed_only() {
  const double first[] = {15,    25.3,  47.5,  54,  56.4, 99.6,  100.3, 112,
                          125.5, 133.4, 192.7, 249, 285,  379.4, 389,   395.2};
  const std::vector<double> later[] = {
      {260.1},      {121.9, 366.3},        {350.2}, {315.4}, {72.2, 342}, {274.7}, {}, {263.5, 373},
      {164.7, 304}, {177.4, 324.9, 364.6}, {},      {324.5}, {},          {},      {}, {}};
  const double factors[] = {.67, .72, .77, .77, .87, .92, .50, .85,
                            .89, .74, .70, .63, .64, .72, .69, .46};
  GrowthTest test{1, 400, {}};
  for (std::size_t i = 0; i < 16; ++i) {
    FailureMode mode{"BD" + std::to_string(i + 1), FixClass::delayed, {first[i]}, {factors[i]}};
    mode.ages.insert(mode.ages.end(), later[i].begin(), later[i].end());
    test.modes.push_back(mode);
  }
  test.modes.push_back(
      {"A", FixClass::none, {63.6, 102.5, 213, 244.8, 250.8, 273.1, 317.1, 320.6, 364.9, 394.9}});
  return test;
}

GrowthTest with_fixes_during() {
  GrowthTest test = delayed_only();
  test.modes.push_back(
      {"BC",
       FixClass::during,
       {0.7, 3.7, 13.2, 17.6, 54.5, 99.2, 112.2, 120.9, 151, 163, 174.5, 191.6, 282.8, 355.2}});
  return test;
}

std::vector<double> mtbf(const ProjectionDraws& draws, double ProjectedIntensity::*member) {
  std::vector<double> values;
  for (const ProjectedIntensity& each : draws.intensity) values.push_back(1 / (each.*member));
  std::sort(values.begin(), values.end());
  return values;
}

// Published by ReliaSoft for this example: beta-bar 0.7472, h(T) 0.0299/h, demonstrated 9.52 h, projected 0.0661/h and
// 15.13 h, growth potential 22.45 h; with fixes during the test demonstrated 0.1274/h.
TEST(Projection, HasCrowsPublishedEstimates) {
  const auto crow = crow_projection(delayed_only());
  ASSERT_TRUE(crow);
  EXPECT_NEAR(crow->beta, 0.7472, 1e-4);
  EXPECT_NEAR(crow->intensity.new_modes, 0.0299, 5e-5);
  EXPECT_NEAR(1 / crow->intensity.demonstrated, 9.5238, 5e-5);
  EXPECT_NEAR(crow->intensity.projected, 0.0661, 5e-5);
  EXPECT_NEAR(1 / crow->intensity.projected, 15.13, 5e-3);
  EXPECT_NEAR(1 / crow->intensity.potential, 22.4467, 5e-5);
  const auto mixed = crow_projection(with_fixes_during());
  ASSERT_TRUE(mixed);
  EXPECT_NEAR(mixed->intensity.demonstrated, 0.1274, 5e-5);
  EXPECT_NEAR(1 / mixed->intensity.projected, 11.29418, 1e-5);  // tests/golden/projection.R
  EXPECT_NEAR(1 / mixed->intensity.potential, 14.92852, 1e-5);
}

TEST(Projection, CrowNeedsTwoModes) {
  GrowthTest test{1, 100, {{"B", FixClass::delayed, {20, 30}, {0.7}}}};
  EXPECT_FALSE(crow_projection(test));
  test.modes.push_back({"C", FixClass::delayed, {50}, {0.7}});
  EXPECT_TRUE(crow_projection(test));
  test.modes = {{"B", FixClass::delayed, {100}, {0.7}}, {"C", FixClass::delayed, {100}, {0.7}}};
  EXPECT_FALSE(crow_projection(test));
}

// Given beta, the mean is Crow's formula with beta; the mean and the variance over beta in (0, 1) are integrals of a
// truncated gamma density.
TEST(Projection, PosteriorHasTheMomentsOfTheFormula) {
  const GrowthTest test = delayed_only();
  const ProjectionDraws draws = projection_draws(test);
  double logs = 0, constant = 10.5, slope = 0, squares = 10.5, squares_slope = 0;
  for (const FailureMode* mode : test.of(FixClass::delayed)) {
    const double n = static_cast<double>(mode->ages.size()), left = 1 - mode->effectiveness[0];
    logs += std::log(400 / mode->ages.front());
    constant += left * n;
    slope += 1 - left;  // (N_i - beta) (1 - d_i), and beta of unseen modes
    squares += left * left * n;
    squares_slope += 1 - left * left;
  }
  const auto moment = [&](double k) {
    return std::tgamma(16 + k) / std::tgamma(16) / std::pow(logs, k) *
           boost::math::gamma_p(16 + k, logs) / boost::math::gamma_p(16.0, logs);
  };
  const double mean = (constant + slope * moment(1)) / 400,
               variance = (squares + squares_slope * moment(1) +
                           slope * slope * (moment(2) - moment(1) * moment(1))) /
                          (400.0 * 400);
  double sum = 0, sum_of_squares = 0;
  for (const ProjectedIntensity& each : draws.intensity) {
    sum += each.projected;
    sum_of_squares += each.projected * each.projected;
  }
  const double count = static_cast<double>(draws.intensity.size()), found = sum / count;
  EXPECT_NEAR(found, mean, 4 * std::sqrt(variance / count));
  EXPECT_NEAR((sum_of_squares / count - found * found) / variance, 1, 0.03);
}

// Simulated in R (tests/golden/projection.R), 4 million draws.
TEST(Projection, PosteriorQuantilesAreThoseOfR) {
  struct Row {
    GrowthTest test;
    double ProjectedIntensity::*member;
    double low, middle, high;
  };
  using P = ProjectedIntensity;
  const Row rows[] = {{delayed_only(), &P::demonstrated, 7.4405, 9.4838, 12.3552},
                      {delayed_only(), &P::projected, 11.1655, 15.1060, 21.0304},
                      {delayed_only(), &P::potential, 16.2450, 22.1848, 30.7481},
                      {with_fixes_during(), &P::demonstrated, 6.4637, 8.1098, 10.3483},
                      {with_fixes_during(), &P::projected, 9.0615, 11.8948, 15.9450},
                      {with_fixes_during(), &P::potential, 11.9670, 15.9040, 21.3536}};
  for (const Row& row : rows) {
    const std::vector<double> values = mtbf(projection_draws(row.test), row.member);
    EXPECT_NEAR(quantile(values, 0.05) / row.low, 1, 0.01);
    EXPECT_NEAR(quantile(values, 0.5) / row.middle, 1, 0.01);
    EXPECT_NEAR(quantile(values, 0.95) / row.high, 1, 0.01);
  }
}

// The same total time of two units: each unit has half the intensity of what both together show.
TEST(Projection, IntensitiesAreThoseOfOneUnit) {
  GrowthTest one = delayed_only(), two = one;
  two.units = 2;
  const auto of_one = crow_projection(one), of_two = crow_projection(two);
  EXPECT_NEAR(of_two->intensity.projected / of_one->intensity.projected, 0.5, 1e-12);
  EXPECT_NEAR(mtbf(projection_draws(two), &ProjectedIntensity::projected)[100] /
                  mtbf(projection_draws(one), &ProjectedIntensity::projected)[100],
              2, 1e-9);
}

// Fixes of full effect leave the modes that are not fixed and the modes not yet seen; fixes without effect leave all.
TEST(Projection, EffectivenessRunsFromNothingToAll) {
  GrowthTest test = delayed_only();
  for (FailureMode& each : test.modes)
    if (each.fix == FixClass::delayed) each.effectiveness = {0};
  for (const ProjectedIntensity& each : projection_draws(test).intensity) {
    ASSERT_DOUBLE_EQ(each.projected, each.demonstrated);
    ASSERT_DOUBLE_EQ(each.potential, each.demonstrated);
  }
  EXPECT_NEAR(crow_projection(test)->intensity.projected, 42.0 / 400, 1e-12);
  for (FailureMode& each : test.modes)
    if (each.fix == FixClass::delayed) each.effectiveness = {1};
  EXPECT_NEAR(crow_projection(test)->intensity.potential, 10.0 / 400, 1e-12);
  EXPECT_NEAR(crow_projection(test)->intensity.projected,
              10.0 / 400 + crow_projection(test)->intensity.new_modes, 1e-12);
}

// An uncertain factor widens the posterior and keeps its mean.
TEST(Projection, UncertainFactorsWidenIt) {
  GrowthTest known = delayed_only(), unsure = known;
  for (FailureMode& each : known.modes)
    if (each.fix == FixClass::delayed) each.effectiveness = {0.5};
  for (FailureMode& each : unsure.modes)
    if (each.fix == FixClass::delayed) each.effectiveness = {0, 1};
  EXPECT_NEAR(crow_projection(known)->intensity.projected,
              crow_projection(unsure)->intensity.projected, 1e-12);
  const auto width = [](const GrowthTest& test) {
    const std::vector<double> all = mtbf(projection_draws(test), &ProjectedIntensity::potential);
    return std::log(quantile(all, 0.95) / quantile(all, 0.05));
  };
  EXPECT_GT(width(unsure), 1.1 * width(known));
}

TEST(Projection, RisingDiscoveryIsSeen) {
  GrowthTest test{1, 100, {}};
  for (int i = 0; i < 12; ++i)
    test.modes.push_back({std::to_string(i), FixClass::delayed, {95.0 + i / 4.0}, {0.7}});
  EXPECT_GT(probability_of_rising_discovery(test), 0.95);
  EXPECT_LT(probability_of_rising_discovery(delayed_only()), 0.5);
}

}  // namespace
}  // namespace wearwell::recurrence
