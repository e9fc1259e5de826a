#include "wearwell/plan/inspection_costs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plan/random_lives.h"
#include "prognosis/weibull_lives.h"
#include "wearwell/math/constants.h"
#include "wearwell/prognosis/inspection.h"

namespace wearwell::plan {
namespace {

using prognosis::weibull_lives;

InspectionPrices hidden_prices() {
  InspectionPrices prices{0.7, 9, 0};
  prices.downtime = 0.5;
  return prices;
}

InspectionPrices evident_prices(double warning) {
  InspectionPrices prices{0.3, 20, 4};
  prices.warning = warning;
  prices.use = 0.11;
  return prices;
}

// What one unit costs that fails at this time.
double paid(double end, const std::vector<double>& times, double until,
            const InspectionPrices& prices) {
  double cost = 0, last = -1;
  for (const double each : times) {
    if (!prices.downtime && each >= end) break;
    cost += prices.inspection;
    last = each;
    if (each >= end) break;
  }
  if (prices.downtime) {
    if (end > until) return cost;
    const double found = last >= end ? last : until;
    return cost + prices.failure + *prices.downtime * (found - end);
  }
  if (end > until) return cost;
  const bool foreseen = last >= 0 && end <= last + prices.warning;
  return cost + (foreseen ? prices.replacement + prices.use * (end - last) : prices.failure);
}

TEST(InspectionCost, IsWhatASimulationPays) {
  Rng rng(7, 0);
  const LifeAhead life(0.03, weibull_lives(2.2, 100));
  const std::vector<double> times = {8, 30, 62, 80};
  constexpr int runs = 200'000;
  for (const InspectionPrices& prices :
       {hidden_prices(), evident_prices(infinity), evident_prices(15)}) {
    double sum = 0, square = 0;
    for (int i = 0; i < runs; ++i) {
      const double cost = paid(drawn(life, rng), times, 110, prices);
      sum += cost;
      square += cost * cost;
    }
    const double mean = sum / runs;
    EXPECT_NEAR(cost_of(life, times, 110, prices).total, mean,
                4 * std::sqrt((square / runs - mean * mean) / runs));
  }
}

// Over a whole life, equal intervals cost what `decide` says.
TEST(InspectionCost, IsThatOfDecideForEqualIntervals) {
  const prognosis::WeightedLives lives = weibull_lives(2.2, 100);
  const LifeAhead life(0, lives);
  const prognosis::Costs costs{9, 4, 0.7};
  for (const double interval : {11.0, 40.0}) {
    const double until = interval * std::ceil(lives.points().back() / interval + 2);
    const std::vector<double> times = equal_times(interval, until);
    const prognosis::InspectedLife hidden = hidden_failure(lives, costs, 0.5, interval);
    const InspectionCost same = cost_of(life, times, until, hidden_prices());
    EXPECT_NEAR(same.total, hidden.cost, 1e-3 * hidden.cost);
    EXPECT_NEAR(same.inspections, hidden.inspections, 1e-3 * hidden.inspections);
    const prognosis::InspectedLife seen = perfect_inspection(lives, costs, interval);
    const InspectionCost own = cost_of(life, times, until, {0.7, 9, 4});
    EXPECT_NEAR(own.total, seen.cost, 1e-3 * seen.cost);
    EXPECT_NEAR(own.failing, seen.failing, 1e-9);
    // Use that is not lost is the length of the life under inspection.
    EXPECT_NEAR(lives.mean_up_to(1e9) - own.lost, seen.length, 2e-3 * seen.length);
  }
}

TEST(CheapestInspections, AreTheCheapestOfAllPlans) {
  Rng rng(8, 0);
  constexpr int places = 11;
  int planned = 0, bounded = 0;
  for (int run = 0; run < 40; ++run) {
    const LifeAhead life = random_life(rng, 11);
    InspectionPrices prices = run % 2 ? hidden_prices() : evident_prices(1 + 4 * rng.uniform());
    prices.visit = run % 3 == 0 ? 0.2 : 0;
    const InspectionBounds bounds{run % 4 < 2 ? 1 : 0.15 + 0.5 * rng.uniform(), places, 1};
    double least = infinity;
    for (unsigned bits = 0; bits < 1U << places; ++bits) {
      const std::vector<double> times = subset(bits, 1, 0);
      if (!times.empty() && times[0] == 0 && life.passed() == 0) continue;
      if (!keeps_bound(risks_between(life, times, bounds.until), bounds.risk)) continue;
      least = std::min(least, cost_of(life, times, bounds.until, prices).total);
    }
    const CheapestTimes best = cheapest_inspections(life, bounds, prices);
    ASSERT_EQ(best.plan.stuck.has_value(), !std::isfinite(least));
    if (best.plan.stuck) continue;
    ++planned;
    bounded += bounds.risk < 1;
    EXPECT_NEAR(best.cost.total, least, 1e-9 * least);
  }
  EXPECT_GT(planned, 25);
  EXPECT_GT(bounded, 5);
}

// With a constant hazard and a horizon far away the intervals are equal, exp(x) - x = 1 + c_i / (d mean) with x = interval /
// mean (Barlow and Proschan, 1965, chapter 4, section 3.2).
TEST(CheapestInspections, OfAConstantHazardAreThoseOfBarlowAndProschan) {
  const double mean = 100;
  const LifeAhead life(0, weibull_lives(1, mean, 40000));
  InspectionPrices prices{3, 50, 0};
  prices.downtime = 2;
  const CheapestTimes best = cheapest_inspections(life, {1, 500, 0}, prices);
  double x = 0.2;
  for (int i = 0; i < 50; ++i) x -= (std::exp(x) - x - 1 - 3 / (2 * mean)) / (std::exp(x) - 1);
  ASSERT_GT(best.plan.times.size(), 15);
  double before = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(best.plan.times[k] - before, x * mean, 0.02 * x * mean) << k;
    before = best.plan.times[k];
  }
}

// An increasing hazard: intervals shrink, no equal interval is as cheap, and no small move of one time helps.
TEST(CheapestInspections, AreBetterThanEqualIntervals) {
  const LifeAhead life(0, weibull_lives(3, 100, 20000));
  for (const InspectionPrices& prices : {hidden_prices(), evident_prices(20)}) {
    const InspectionBounds bounds{1, 120, 0};
    const CheapestTimes best = cheapest_inspections(life, bounds, prices);
    const EqualInterval equal = cheapest_equal(life, bounds, prices);
    ASSERT_GT(best.plan.times.size(), 2);
    EXPECT_LT(best.cost.total, equal.cost.total);
    for (std::size_t k = 0; k < best.plan.times.size(); ++k) {
      for (const double move : {-0.5, 0.5}) {
        std::vector<double> moved = best.plan.times;
        moved[k] += move;
        EXPECT_GE(cost_of(life, moved, 120, prices).total, best.cost.total - 1e-7);
      }
    }
  }
}

TEST(CheapestInspections, AreNoneWhereNonePays) {
  const LifeAhead life(0, weibull_lives(3, 100));
  InspectionPrices prices = hidden_prices();
  prices.inspection = 1000;
  const CheapestTimes best = cheapest_inspections(life, {1, 80, 0}, prices);
  EXPECT_TRUE(best.plan.times.empty());
  EXPECT_FALSE(best.plan.stuck);
  EXPECT_TRUE(std::isinf(cheapest_equal(life, {1, 80, 0}, prices).interval));
}

}  // namespace
}  // namespace wearwell::plan
