// The integral over the effect of a unit of Weibull lives, by brute force.
#include "wearwell/models/formula_model/extreme_value_unit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "wearwell/base/rng.h"
#include "wearwell/math/constants.h"

namespace wearwell::formula_model {
namespace {

// The mode by bisection of the slope, then steps of a five-hundredth of the width there, and of a twentieth of that
// over which the hazard changes.
double brute_force(const ExtremeValueUnit& unit) {
  const auto slope = [&](double z) {
    return unit.rate * (std::exp(unit.log_sum - unit.rate * z) - unit.failures) - z;
  };
  double low = -1e6, high = 1e6;
  for (int round = 0; round < 200; ++round) {
    const double middle = 0.5 * (low + high);
    (slope(middle) > 0 ? low : high) = middle;
  }
  const double e = std::exp(unit.log_sum - unit.rate * low);
  const double width = 1 / std::sqrt(1 + unit.rate * unit.rate * e), top = unit.at(low);
  const double step = std::min(0.002 * width, 0.05 / (1e-3 + std::abs(unit.rate)));
  double sum = 0;
  for (const double way : {1.0, -1.0}) {
    for (int i = way > 0 ? 0 : 1; i < 20'000'000; ++i) {
      const double f = unit.at(low + way * i * step) - top;
      if (f < -50) break;
      sum += std::exp(f) * step;
    }
  }
  return top + std::log(sum) - half_log_two_pi;
}

// No failures and thousands, scatters from a thousandth to those of many shapes, either sign.
TEST(ExtremeValueUnit, IsTheIntegralByBruteForce) {
  Rng rng(20261128, 0);
  ExtremeValueUnit::Nodes nodes;
  for (int i = 0; i < 60; ++i) {
    const double failures = i % 5 == 0 ? 0 : std::floor(std::exp(8 * rng.uniform()));
    const double rate = (i % 2 == 0 ? 1 : -1) * std::exp(-7 + 10 * rng.uniform());
    const ExtremeValueUnit unit{
        failures, std::log(failures + 0.1) + rate * rng.normal() + 2 * rng.normal(), rate};
    const double expected = brute_force(unit);
    for (const auto& gaps : {std::span<const double>(ExtremeValueUnit::coarse),
                             std::span<const double>(ExtremeValueUnit::fine)}) {
      const auto integral = unit.log_integral(nodes, gaps);
      ASSERT_TRUE(integral) << failures << " " << unit.log_sum << " " << rate;
      EXPECT_NEAR(*integral, expected, 1e-9 * (1 + std::abs(expected)))
          << failures << " " << unit.log_sum << " " << rate;
      double all = 0;
      for (std::size_t n = 0; n < nodes.count; ++n) {
        all += nodes.f[n];
        const double hazard = std::exp(unit.log_sum - rate * nodes.z[n]);
        EXPECT_NEAR(nodes.hazard[n], hazard, 1e-10 * hazard);
      }
      EXPECT_NEAR(all, 1, 1e-12);
    }
  }
}

// Rows that contradict the population, and rows that say nothing.
TEST(ExtremeValueUnit, HoldsFarFromThePopulation) {
  ExtremeValueUnit::Nodes nodes;
  for (const ExtremeValueUnit unit : {ExtremeValueUnit{3, 60, 0.5},
                                      {3, -200, 0.5},
                                      {1, -90, 9},
                                      {0, -300, 2},
                                      {0, 30, 25},
                                      {0, -15, 5},
                                      {1, -30, 4},
                                      {2, 1, 0},
                                      {0, -infinity, 1.5}}) {
    const auto integral = unit.log_integral(nodes);
    ASSERT_TRUE(integral) << unit.log_sum;
    const double expected = brute_force(unit);
    EXPECT_NEAR(*integral, expected, 1e-9 * (1 + std::abs(expected))) << unit.log_sum;
  }
}

// No failures and a population that scatters by many shapes: a step of the population's distribution.
TEST(ExtremeValueUnit, ScattersByManyShapes) {
  Rng rng(20261129, 0);
  ExtremeValueUnit::Nodes nodes;
  for (int i = 0; i < 40; ++i) {
    const double rate = (i % 2 == 0 ? 1 : -1) * std::exp(2.1 + 4 * rng.uniform());
    const ExtremeValueUnit unit{0, std::abs(rate) * (10 * rng.uniform() - 7), rate};
    const auto integral = unit.log_integral(nodes);
    ASSERT_TRUE(integral) << unit.log_sum << " " << rate;
    const double expected = brute_force(unit);
    EXPECT_NEAR(*integral, expected, 1e-9 * (1 + std::abs(expected)))
        << unit.log_sum << " " << rate;
    double hazard = 0;  // of which the mean is the derivative by -log_sum
    for (std::size_t n = 0; n < nodes.count; ++n) hazard += nodes.f[n] * nodes.hazard[n];
    const double step = 1e-4;
    const double by_step = (brute_force({0, unit.log_sum - step, rate}) -
                            brute_force({0, unit.log_sum + step, rate})) /
                           (2 * step);
    EXPECT_NEAR(hazard, by_step, 1e-6 * (1 + hazard));
  }
  const auto half = ExtremeValueUnit{0, 0, 1e7}.log_integral(nodes);
  ASSERT_TRUE(half);
  EXPECT_NEAR(*half, std::log(0.5), 1e-6);  // half of the population
}

// Nodes that do not resolve the unit are refused, not summed.
TEST(ExtremeValueUnit, RefusesWhatItDoesNotResolve) {
  ExtremeValueUnit::Nodes nodes;
  EXPECT_FALSE((ExtremeValueUnit{0, 1e9, 20}.log_integral(nodes)));
  EXPECT_FALSE((ExtremeValueUnit{1, std::nan(""), 1}.log_integral(nodes)));
}

}  // namespace
}  // namespace wearwell::formula_model
