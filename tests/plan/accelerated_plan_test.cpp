#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/plan/accelerated_test.h"
#include "wearwell/plan/planning_value.h"

namespace wearwell::plan {
namespace {

using enum StandardDistribution;

// Meeker and Escobar, Statistical Methods for Reliability Data (1998), ch. 20, adhesive bond: Weibull, sigma 0.6, 0.1 % fail at
// 50 degC and 90 % at 120 degC within 183 days; 10 % quantile at 50 degC; 300 units.
AccelerationGoal adhesive_bond() {
  const double at_use = std::log(-std::log1p(-0.001));
  return {smallest_extreme_value, 0.1, {{at_use, std::log(-std::log1p(-0.9)) - at_use, 0.6, 1}}};
}
double bond_xi(double celsius) {
  const double use = 1 / 323.15, highest = 1 / 393.15;
  return (1 / (celsius + 273.15) - use) / (highest - use);
}

TEST(CensoredInformation, IsTheKnownOneWithoutCensoring) {
  const double euler = 0.57721566490153286, pi = 3.14159265358979324;
  const auto weibull = CensoredInformation(smallest_extreme_value)(1e6);
  EXPECT_NEAR(weibull.location, 1, 1e-8);
  EXPECT_NEAR(weibull.both, 1 - euler, 1e-8);
  EXPECT_NEAR(weibull.scale, pi * pi / 6 + (1 - euler) * (1 - euler), 1e-8);
  const auto lognormal = CensoredInformation(normal)(1e6);
  EXPECT_NEAR(lognormal.location, 1, 1e-8);
  EXPECT_NEAR(lognormal.both, 0, 1e-8);
  EXPECT_NEAR(lognormal.scale, 2, 1e-8);
  const auto loglogistic = CensoredInformation(logistic)(1e6);
  EXPECT_NEAR(loglogistic.location, 1.0 / 3, 1e-8);
  EXPECT_NEAR(loglogistic.scale, (pi * pi + 3) / 9, 1e-8);
}

// By the other formula, scores of failures and of survivors (Escobar and Meeker 1994), with a plain sum.
TEST(CensoredInformation, IsThatOfTheScores) {
  for (const StandardDistribution d : {smallest_extreme_value, normal, logistic}) {
    const CensoredInformation information(d);
    for (const double zeta : {-4.0, -2.0, -0.5, 0.7, 2.0}) {
      double location = 0, both = 0, scale = 0;
      constexpr double step = 1e-3;
      for (double z = zeta - 0.5 * step; z > -30; z -= step) {
        const ValueAndSlope f = log_density_and_slope(d, z);
        const double g = f.slope, h = 1 + z * g, p = std::exp(f.value) * step;
        location += g * g * p;
        both += g * h * p;
        scale += h * h * p;
      }
      const ValueAndSlope s = log_survival_and_slope(d, zeta);
      const double rest = s.slope * s.slope * std::exp(s.value);
      const auto found = information(zeta);
      EXPECT_NEAR(found.location, location + rest, 1e-5);
      EXPECT_NEAR(found.both, both + zeta * rest, 1e-5);
      EXPECT_NEAR(found.scale, scale + zeta * zeta * rest, 1e-5);
    }
  }
}

// The mean of the observed information (products of scores) of simulated censored lives.
TEST(CensoredInformation, IsTheMeanOfSimulatedScores) {
  for (const StandardDistribution d : {smallest_extreme_value, normal}) {
    constexpr double zeta = 0.4;
    constexpr int n = 200000;
    Rng random(3, static_cast<std::uint64_t>(d));
    double sum[3] = {}, squares[3] = {};
    for (int i = 0; i < n; ++i) {
      const double z = quantile(d, random.uniform());
      double by_location = 0, by_scale = 0;
      if (z < zeta) {
        by_location = -log_density_and_slope(d, z).slope;
        by_scale = -1 + z * by_location;
      } else {
        by_location = -log_survival_and_slope(d, zeta).slope;
        by_scale = zeta * by_location;
      }
      const double product[] = {by_location * by_location, by_location * by_scale,
                                by_scale * by_scale};
      for (int k = 0; k < 3; ++k) {
        sum[k] += product[k];
        squares[k] += product[k] * product[k];
      }
    }
    const auto found = CensoredInformation(d)(zeta);
    const double values[] = {found.location, found.both, found.scale};
    for (int k = 0; k < 3; ++k) {
      const double mean = sum[k] / n, error = std::sqrt((squares[k] / n - mean * mean) / n);
      EXPECT_NEAR(mean, values[k], 4 * error) << k;
    }
  }
}

// The book's optimum plan: 212 units at 95 degC, 88 at 120 degC; standard error of the log quantile 0.3794.
TEST(BestPlan, IsTheOptimumOfMeekerAndEscobar) {
  const CensoredInformation information(smallest_extreme_value);
  const AccelerationGoal goal = adhesive_bond();
  const auto plan = best_plan(PlanKind::optimum, goal, information, 0, 0.2);
  ASSERT_EQ(plan.size(), 2U);
  EXPECT_NEAR(plan[0].xi, bond_xi(95), 0.005);
  EXPECT_NEAR(300 * plan[0].share, 212, 0.5);
  EXPECT_NEAR(std::sqrt(goal_variance(goal, information, plan) / 300), 0.3794, 5e-5);
}

// Its 20 % compromise plan, with the lower level at 78 degC: 155, 60 and 84 units at 78, 98 and 120 degC; 0.4375; its
// traditional reasons for the lower level are those of extrapolation, not of variance.
TEST(BestAllocation, IsTheCompromiseOfMeekerAndEscobar) {
  const CensoredInformation information(smallest_extreme_value);
  const AccelerationGoal goal = adhesive_bond();
  const auto plan = best_allocation(PlanKind::compromise, goal, information, bond_xi(78), 0.2);
  EXPECT_NEAR(plan[1].xi, bond_xi(98), 0.005);
  EXPECT_NEAR(300 * plan[0].share, 155.5, 0.6);
  EXPECT_NEAR(300 * plan[2].share, 84.3, 0.6);
  EXPECT_NEAR(std::sqrt(goal_variance(goal, information, plan) / 300), 0.4375, 5e-4);
}

// Meeker and Escobar (1998), example 20.8, insulation under voltage and temperature, as quoted by
// ReliaSoft ("Optimal Test Plan for Two Stresses"): Weibull, shape 1.485, log scale = 58.173 - 12.28
// log(V/mm) + 0.3878 x 11605/T; use 80 V/mm and 120 degC, highest 200 V/mm and 260 degC; 170 units for
// 1000 h. The plan, 62 units at 124 V/mm and 260 degC, 42 at 159 V/mm and 120 degC, 66 at the highest,
// splits the lower level of the optimum plan along the line between use and highest into two points of
// the same life, which keeps the variance: 104 units there. Its standard error, 0.3670, and its levels
// are those of the 0.1 % quantile.
TEST(BestPlan, IsTheOptimumForInsulationOfMeekerAndEscobar) {
  const CensoredInformation information(smallest_extreme_value);
  const auto log_scale = [](double volts, double kelvin) {
    return 58.173 - 12.28 * std::log(volts) + 0.3878 * 11605 / kelvin;
  };
  const double use = log_scale(80, 393.15), highest = log_scale(200, 533.15), shape = 1.485;
  const AccelerationGoal goal{
      smallest_extreme_value,
      0.001,
      {{shape * (std::log(1000) - use), shape * (use - highest), 1 / shape, 1}}};
  const auto plan = best_plan(PlanKind::optimum, goal, information, 0, 0.2);
  ASSERT_EQ(plan.size(), 2U);
  for (const double lower : {log_scale(124, 533.15), log_scale(159, 393.15)})
    EXPECT_NEAR(plan[0].xi, (use - lower) / (use - highest), 0.003);
  EXPECT_EQ(whole_allocation(plan, 170), (std::vector<std::size_t>{62 + 42, 66}));
  EXPECT_NEAR(std::sqrt(goal_variance(goal, information, plan) / 170), 0.3670, 1e-4);
}

// Stop times by level enter through the information of each level only: by hand, and complete tests
// as the limit of long ones. The same time at all levels is one stop time.
TEST(BestAllocation, UsesTheStopTimeOfEachLevel) {
  const CensoredInformation information(smallest_extreme_value);
  AccelerationGoal goal = adhesive_bond();
  const PlanningPoint point = goal.points.front();
  const std::vector<TestLevel> levels = {{0.5, 0.6, std::log(2)}, {1, 0.4, std::log(0.5)}};
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const TestLevel& level : levels) {
    const auto f = information(point.at_use + point.rise * level.xi + level.log_stop / point.scale);
    Eigen::Matrix3d one;
    one << f.location, f.location * level.xi, f.both, f.location * level.xi,
        f.location * level.xi * level.xi, f.both * level.xi, f.both, f.both * level.xi, f.scale;
    sum += level.share * one;
  }
  const Eigen::Vector3d c(1, 0, quantile(smallest_extreme_value, 0.1));
  EXPECT_NEAR(goal_variance(goal, information, levels), 0.36 * c.dot(sum.inverse() * c), 1e-6);

  AccelerationGoal longer = goal, shifted = goal, complete = goal;
  longer.log_stops = {std::log(4), std::log(2), 0};
  const auto error = [&](const AccelerationGoal& of, PlanKind kind) {
    return goal_variance(of, information, best_plan(kind, of, information, 0, 0.2));
  };
  for (const PlanKind kind : {PlanKind::optimum, PlanKind::compromise, PlanKind::equal})
    EXPECT_LT(error(longer, kind), 0.5 * error(goal, kind));
  for (double& each : longer.log_stops) each = std::log(3);
  shifted.points.front().at_use += std::log(3) / 0.6;
  EXPECT_NEAR(error(longer, PlanKind::compromise), error(shifted, PlanKind::compromise), 1e-9);
  for (double& each : complete.log_stops) each = 60;
  const auto plan = best_allocation(PlanKind::equal, complete, information, 0.2, 0.2);
  EXPECT_NEAR(failing_at(complete, plan.front()), 1, 1e-12);
}

// Chernoff (1962), exponential lives and few failures: the two levels differ by 2 u in the log failure rate, u the root of e^u
// (u - 1) = 1, and the weights are as e^u to the lower level's place.
TEST(BestPlan, HasTheTwoPointsOfChernoff) {
  const CensoredInformation information(smallest_extreme_value);
  const double rise = 7, u = 1.2784645427610738;
  AccelerationGoal goal{smallest_extreme_value, 0.1, {{-16, rise, 1, 1}}, true};
  const auto plan = best_plan(PlanKind::optimum, goal, information, 0, 0.2);
  const double xi = 1 - 2 * u / rise;
  EXPECT_NEAR(plan[0].xi, xi, 0.002);
  EXPECT_NEAR(plan[0].share, std::exp(u) / (std::exp(u) + xi), 0.002);
}

// Without censoring the median of normal lives is a straight line's value: the ends of the range, with the weights of Hoel and
// Levine (1964), as the Lagrange polynomials at the use condition.
TEST(BestPlan, HasTheWeightsOfHoelAndLevine) {
  const CensoredInformation information(normal);
  const AccelerationGoal goal{normal, 0.5, {{50, 10, 0.7, 1}}};
  for (const double lowest : {0.2, 0.4, 0.7}) {
    const auto plan = best_plan(PlanKind::optimum, goal, information, lowest, 0.2);
    EXPECT_NEAR(plan[0].xi, lowest, 1e-6);
    EXPECT_NEAR(plan[0].share, 1 / (1 + lowest), 1e-4);
    EXPECT_NEAR(goal_variance(goal, information, plan) / 0.49,
                std::pow((1 + lowest) / (1 - lowest), 2), 1e-6);
  }
}

// No weight anywhere improves the optimum plan (equivalence theorem), and no other pair of levels is better.
TEST(BestPlan, IsOptimumByTheEquivalenceTheoremAndBruteForce) {
  for (const StandardDistribution d : {smallest_extreme_value, normal, logistic}) {
    const CensoredInformation information(d);
    AccelerationGoal goal = adhesive_bond();
    goal.distribution = d;
    const double at_use = quantile(d, 0.001);
    goal.points = {{at_use, quantile(d, 0.9) - at_use, 0.6, 1}};
    const auto plan = best_plan(PlanKind::optimum, goal, information, 0, 0.2);
    const double least = goal_variance(goal, information, plan);
    for (double xi = 0; xi <= 1; xi += 0.01)
      EXPECT_LT(gain_at(goal, information, plan, xi), 1 + 1e-4) << xi;
    EXPECT_NEAR(gain_at(goal, information, plan, plan[0].xi), 1, 1e-4);
    for (double low = 0.05; low < 0.95; low += 0.05)
      for (double high = low + 0.05; high <= 1; high += 0.05)
        for (double share = 0.1; share < 1; share += 0.1)
          EXPECT_GE(goal_variance(goal, information,
                                  std::vector<TestLevel>{{low, share}, {high, 1 - share}}),
                    least * (1 - 1e-9));
  }
}

// Averaged over planning values the variance is the mean of the variances, and the plan is best for the mean.
TEST(BestPlan, AveragesOverPlanningValues) {
  const CensoredInformation information(smallest_extreme_value);
  AccelerationGoal low = adhesive_bond(), high = adhesive_bond(), both = adhesive_bond();
  high.points[0].at_use -= 1;
  high.points[0].scale = 0.8;
  both.points = {low.points[0], high.points[0]};
  both.points[0].weight = 0.3;
  both.points[1].weight = 0.7;
  const auto plan = best_plan(PlanKind::compromise, both, information, 0, 0.2);
  const auto variance = [&](const AccelerationGoal& goal, const std::vector<TestLevel>& levels) {
    return goal_variance(goal, information, levels);
  };
  EXPECT_NEAR(variance(both, plan), 0.3 * variance(low, plan) + 0.7 * variance(high, plan), 1e-9);
  for (const AccelerationGoal* each : {&low, &high})
    EXPECT_LE(variance(both, plan),
              variance(both, best_plan(PlanKind::compromise, *each, information, 0, 0.2)));
}

TEST(GoalVariance, IsInfiniteWhereLevelsDetermineNothing) {
  const CensoredInformation information(smallest_extreme_value);
  const AccelerationGoal goal = adhesive_bond();
  EXPECT_TRUE(std::isinf(goal_variance(goal, information, std::vector<TestLevel>{{1, 1}})));
  EXPECT_TRUE(std::isinf(
      curvature_variance(goal, information, std::vector<TestLevel>{{0.5, 0.5}, {1, 0.5}})));
}

// Without censoring the variance of the quadratic coefficient of normal lives is that of least squares on three points.
TEST(CurvatureVariance, IsThatOfLeastSquares) {
  const CensoredInformation information(normal);
  const AccelerationGoal goal{normal, 0.5, {{50, 10, 0.7, 1}}};
  const std::vector<TestLevel> levels = {{0.4, 0.5}, {0.7, 0.2}, {1, 0.3}};
  // second difference: (y1 - 2 y2 + y3) / (2 h^2)
  const double h = 0.3;
  const double expected = 0.49 * (1 / 0.5 + 4 / 0.2 + 1 / 0.3) / std::pow(2 * h * h, 2);
  EXPECT_NEAR(curvature_variance(goal, information, levels) / expected, 1, 1e-8);
}

TEST(WholeAllocation, KeepsTheSum) {
  const std::vector<TestLevel> levels = {{0.3, 4.0 / 7}, {0.6, 2.0 / 7}, {1, 1.0 / 7}};
  EXPECT_EQ(whole_allocation(levels, 70), (std::vector<std::size_t>{40, 20, 10}));
  for (std::size_t n = 4; n < 60; ++n) {
    std::size_t sum = 0;
    for (const std::size_t each : whole_allocation(levels, n)) sum += each;
    EXPECT_EQ(sum, n);
  }
}

TEST(EnoughFailures, IsTheBinomialTail) {
  const AccelerationGoal goal = adhesive_bond();
  const double p = failing_at(goal, {0.5});
  EXPECT_NEAR(enough_failures(goal, {0.5}, 10, 1), 1 - std::pow(1 - p, 10), 1e-12);
  EXPECT_NEAR(failing_at(goal, {0}), 0.001, 1e-12);
  EXPECT_NEAR(failing_at(goal, {1}), 0.9, 1e-12);
  // Twice the stop time at shape 1/0.6: the cumulative hazard grows by 2^(1/0.6).
  EXPECT_NEAR(failing_at(goal, {0, 1, std::log(2)}),
              -std::expm1(std::log1p(-0.001) * std::pow(2, 1 / 0.6)), 1e-12);
}

TEST(PlanningValue, HasItsIntervalAndNodes) {
  const PlanningValue shape = read_planning_value("--shape", "1.5 to 3");
  EXPECT_NEAR(shape.at(z05), 1.5, 1e-12);
  EXPECT_NEAR(shape.at(z95), 3, 1e-12);
  const PlanningValue prior = read_planning_value("--shape", "lognormal, median = 2, log_sd = 0.2");
  EXPECT_NEAR(prior.at(1), 2 * std::exp(0.2), 1e-9);
  const PlanningValue share =
      read_planning_share("--failing-at-use", "0.05 % to 0.2 %", smallest_extreme_value);
  EXPECT_NEAR(share.at(z05), 0.0005, 1e-12);
  EXPECT_NEAR(share.at(z95), 0.002, 1e-12);
  double weight = 0, square = 0, eighth = 0;
  for (const NormalNode& node : normal_nodes(7)) {
    weight += node.weight;
    square += node.weight * node.z * node.z;
    eighth += node.weight * std::pow(node.z, 8);
  }
  EXPECT_NEAR(weight, 1, 1e-12);
  EXPECT_NEAR(square, 1, 1e-12);
  EXPECT_NEAR(eighth, 105, 1e-9);
}

}  // namespace
}  // namespace wearwell::plan
