#include "wearwell/plan/joint_visits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plan/random_lives.h"
#include "wearwell/math/constants.h"

namespace wearwell::plan {
namespace {

// The least over all plans of one unit at some of these visits.
double least_of_unit(const LifeAhead& life, const InspectionBounds& bounds,
                     const InspectionPrices& prices, const std::vector<double>& visits) {
  double least = infinity;
  for (unsigned bits = 0; bits < 1U << visits.size(); ++bits) {
    std::vector<double> times;
    for (std::size_t k = 0; k < visits.size(); ++k)
      if (bits >> k & 1U && visits[k] < bounds.until) times.push_back(visits[k]);
    if (keeps_bound(risks_between(life, times, bounds.until), bounds.risk))
      least = std::min(least, cost_of(life, times, bounds.until, prices).total);
  }
  return least;
}

// Three units and eight places: all 256 sets of visits, and for each all plans of every unit.
TEST(CheapestVisits, AreTheCheapestOfAllPlans) {
  Rng rng(9, 0);
  int same = 0, grouped = 0;
  constexpr int runs = 30, places = 8;
  std::vector<double> candidates;
  for (int k = 0; k < places; ++k) candidates.push_back(k + 1);
  for (int run = 0; run < runs; ++run) {
    InspectionPrices prices{0.2, 15, 3};
    if (run % 2) prices.downtime = 1;
    prices.warning = 2.5;
    prices.use = 0.2;
    std::vector<LifeAhead> units;
    std::vector<InspectionBounds> bounds;
    for (int u = 0; u < 3; ++u) {
      units.push_back(random_life(rng, 9));
      bounds.push_back({1, places + 1 - 3 * rng.uniform(), 1});
    }
    const double visit = 0.1 + rng.uniform();
    double least = infinity;
    for (unsigned bits = 0; bits < 1U << places; ++bits) {
      const std::vector<double> visits = subset(bits, 1, 1);
      double cost = visit * static_cast<double>(visits.size());
      for (std::size_t u = 0; u < 3; ++u)
        cost += least_of_unit(units[u], bounds[u], prices, visits);
      least = std::min(least, cost);
    }
    prices.visit = visit;
    const JointVisits joint = cheapest_visits(units, bounds, prices, candidates);
    EXPECT_GE(joint.total, least - 1e-9);
    EXPECT_LE(joint.total, 1.005 * least);
    EXPECT_LE(joint.least_possible, least + 1e-9);
    same += joint.total < least + 1e-9;
    // The parts are the whole.
    double sum = visit * static_cast<double>(joint.visits.size());
    std::size_t inspections = 0;
    for (std::size_t u = 0; u < 3; ++u) {
      sum += joint.costs[u].total;
      inspections += joint.of_unit[u].size();
    }
    EXPECT_NEAR(joint.total, sum, 1e-9);
    grouped += inspections > joint.visits.size();
  }
  EXPECT_GE(same, runs * 8 / 10);  // the others within 0.5 %
  EXPECT_GT(grouped, 10);
}

// Without a cost of visits each unit is planned alone, and that is the bound.
TEST(CheapestVisits, AreThoseOfEachUnitIfVisitsAreFree) {
  Rng rng(10, 0);
  InspectionPrices prices{0.2, 15, 0};
  prices.downtime = 1;
  std::vector<LifeAhead> units;
  std::vector<InspectionBounds> bounds;
  for (int u = 0; u < 5; ++u) {
    units.push_back(random_life(rng, 9));
    bounds.push_back({1, 10, 0.5});
  }
  const JointVisits joint =
      cheapest_visits(units, bounds, prices, candidate_times(units[0], bounds[0]));
  EXPECT_NEAR(joint.total, joint.least_possible, 1e-9 * joint.total);
}

// One unit: the search finds what dynamic programming does.
TEST(CheapestVisits, OfOneUnitAreItsOwn) {
  Rng rng(11, 0);
  InspectionPrices prices{0.2, 15, 0};
  prices.downtime = 1;
  prices.visit = 0.4;
  const std::vector<LifeAhead> units = {random_life(rng, 9)};
  const std::vector<InspectionBounds> bounds = {{1, 10, 0.5}};
  const JointVisits joint =
      cheapest_visits(units, bounds, prices, candidate_times(units[0], bounds[0]));
  const CheapestTimes alone = cheapest_inspections(units[0], bounds[0], prices);
  EXPECT_NEAR(joint.total, alone.cost.total, 1e-9 * alone.cost.total);
  EXPECT_NEAR(joint.least_possible, alone.cost.total, 1e-9 * alone.cost.total);
}

}  // namespace
}  // namespace wearwell::plan
