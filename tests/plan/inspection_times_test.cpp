#include "wearwell/plan/inspection_times.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "plan/random_lives.h"
#include "prognosis/weibull_lives.h"

namespace wearwell::plan {
namespace {

using prognosis::weibull_lives;

TEST(LifeAhead, IsThatOfItsClosedForm) {
  const LifeAhead life(0.1, weibull_lives(1, 100, 20000));
  for (const double time : {3.0, 40.0, 150.0, 400.0}) {
    const double reached = 0.1 + 0.9 * (1 - std::exp(-time / 100));
    EXPECT_NEAR(life.reached(time), reached, 1e-4);
    EXPECT_NEAR(life.used(time), 0.9 * 100 * (1 - std::exp(-time / 100)), 0.05);
    EXPECT_NEAR(life.latest(reached), time, 0.01 * time);
  }
  EXPECT_EQ(life.reached(0), 0.1);
  EXPECT_EQ(life.used(0), 0);
}

// Lives that end and lives that never do.
TEST(LifeAhead, EndsNeverWhereSomeNeverFail) {
  const double never = std::numeric_limits<double>::infinity();
  const std::vector<double> life = {10, 20, 30, never}, weight = {1, 1, 1, 1};
  const LifeAhead ahead(0, prognosis::WeightedLives(life, weight));
  EXPECT_EQ(ahead.latest(0.9), never);
  EXPECT_NEAR(ahead.reached(1e9), 0.75, 1e-12);
  EXPECT_NEAR(ahead.used(1030) - ahead.used(30), 0.25 * 1000, 1e-9);
}

// Of a constant hazard every interval is as long: -mean log(1 - risk).
TEST(FewestInspections, OfAConstantHazardAreEven) {
  const LifeAhead life(0, weibull_lives(1, 100, 40000));
  const double even = -100 * std::log1p(-0.05);
  const InspectionTimes plan = fewest_inspections(life, {0.05, 60, 0});
  ASSERT_EQ(plan.times.size(), std::floor(60 / even));
  for (std::size_t k = 0; k < plan.times.size(); ++k)
    EXPECT_NEAR(plan.times[k], even * static_cast<double>(k + 1), 0.02);
  EXPECT_FALSE(plan.stuck);
}

// The k-th inspection is the quantile of 1 - (1 - risk)^k.
TEST(FewestInspections, OfAWeibullLifeAreItsQuantiles) {
  const LifeAhead life(0, weibull_lives(2.5, 1000, 40000));
  const InspectionTimes plan = fewest_inspections(life, {0.02, 900, 0});
  for (std::size_t k = 0; k < plan.times.size(); ++k) {
    const double exact = 1000 * std::pow(-static_cast<double>(k + 1) * std::log1p(-0.02), 1 / 2.5);
    EXPECT_NEAR(plan.times[k], exact, 1e-3 * exact);
  }
  for (const double risk : risks_between(life, plan.times, 900)) EXPECT_LE(risk, 0.02 + 1e-9);
}

TEST(FewestInspections, BeginNowIfTheThresholdMayBePassed) {
  const LifeAhead life(0.2, weibull_lives(2, 100));
  const InspectionTimes plan = fewest_inspections(life, {0.1, 100, 0});
  ASSERT_FALSE(plan.times.empty());
  EXPECT_EQ(plan.times[0], 0);
  const LifeAhead little(0.05, weibull_lives(2, 100));
  const InspectionTimes later = fewest_inspections(little, {0.1, 100, 0});
  EXPECT_GT(later.times[0], 0);
  EXPECT_NEAR(little.reached(later.times[0]), 0.1, 1e-6);
}

// All 4096 plans at multiples of a step.
TEST(FewestInspections, AreTheFewestOfAllPlans) {
  Rng rng(1, 0);
  constexpr int places = 12;
  int stuck = 0, planned = 0;
  for (int run = 0; run < 60; ++run) {
    const LifeAhead life = random_life(rng, 12);
    const InspectionBounds bounds{0.03 + 0.5 * rng.uniform(), places, 1};
    int fewest = places + 1;
    for (unsigned bits = 0; bits < 1U << places; ++bits) {
      if (std::popcount(bits) >= fewest) continue;
      if (keeps_bound(risks_between(life, subset(bits, 1, 0), bounds.until), bounds.risk))
        fewest = std::popcount(bits);
    }
    const InspectionTimes plan = fewest_inspections(life, bounds);
    EXPECT_EQ(plan.stuck.has_value(), fewest > places);
    stuck += plan.stuck.has_value();
    if (plan.stuck) continue;
    ++planned;
    EXPECT_EQ(plan.times.size(), static_cast<std::size_t>(fewest));
    EXPECT_TRUE(keeps_bound(risks_between(life, plan.times, bounds.until), bounds.risk));
  }
  EXPECT_GT(stuck, 5);
  EXPECT_GT(planned, 20);
}

TEST(FewestVisits, AreTheFewestOfAllPlans) {
  Rng rng(2, 0);
  constexpr int places = 10;
  int planned = 0;
  for (int run = 0; run < 40; ++run) {
    std::vector<LifeAhead> units;
    std::vector<InspectionBounds> bounds;
    for (int u = 0; u < 3; ++u) {
      units.push_back(random_life(rng, 14));
      bounds.push_back({0.1 + 0.4 * rng.uniform(), places - 3.0 * rng.uniform(), 1});
    }
    const auto kept = [&](std::size_t u, const std::vector<double>& visits) {
      std::vector<double> before;
      for (const double each : visits)
        if (each < bounds[u].until) before.push_back(each);
      return keeps_bound(risks_between(units[u], before, bounds[u].until), bounds[u].risk);
    };
    int fewest = places + 1;
    for (unsigned bits = 0; bits < 1U << places; ++bits) {
      const std::vector<double> visits = subset(bits, 1, 0);
      if (std::popcount(bits) < fewest && kept(0, visits) && kept(1, visits) && kept(2, visits))
        fewest = std::popcount(bits);
    }
    const Visits plan = fewest_visits(units, bounds);
    ASSERT_EQ(plan.visits.stuck.has_value(), fewest > places);
    if (plan.visits.stuck) continue;
    ++planned;
    EXPECT_EQ(plan.visits.times.size(), static_cast<std::size_t>(fewest));
    for (std::size_t u = 0; u < 3; ++u) {
      EXPECT_TRUE(kept(u, plan.of_unit[u]));
      // Of these visits no fewer do.
      for (unsigned bits = 0; bits < 1U << plan.visits.times.size(); ++bits) {
        std::vector<double> some;
        for (std::size_t k = 0; k < plan.visits.times.size(); ++k)
          if (bits >> k & 1U) some.push_back(plan.visits.times[k]);
        if (some.size() < plan.of_unit[u].size()) {
          EXPECT_FALSE(kept(u, some));
        }
      }
    }
  }
  EXPECT_GT(planned, 15);
}

TEST(Unforeseen, IsWhatASimulationFinds) {
  Rng rng(3, 0);
  const LifeAhead life(0.02, weibull_lives(2, 100));
  const std::vector<double> times = {10, 40, 55, 90};
  constexpr int runs = 200'000;
  int missed = 0;
  for (int i = 0; i < runs; ++i) {
    const double end = drawn(life, rng);
    bool foreseen = end > 120;
    for (const double each : times) foreseen |= each < end && end <= each + 12;
    missed += !foreseen;
  }
  const double p = unforeseen(life, times, 120, 12);
  EXPECT_NEAR(p, static_cast<double>(missed) / runs, 4 * std::sqrt(p * (1 - p) / runs));
}

TEST(FewestForTotal, AreTheFewestOfAllPlans) {
  Rng rng(4, 0);
  constexpr int places = 10;
  int planned = 0;
  for (int run = 0; run < 60; ++run) {
    const LifeAhead life = random_life(rng, 12);
    const InspectionBounds bounds{0.3 + 0.7 * rng.uniform(), places, 1};
    const double total = 0.4 * rng.uniform(), warning = 0.5 + 3 * rng.uniform();
    std::vector<double> candidates;
    for (int k = 0; k < places; ++k) candidates.push_back(k);
    int fewest = places + 1;
    double least = 1;
    for (unsigned bits = 0; bits < 1U << places; ++bits) {
      const std::vector<double> times = subset(bits, 1, 0);
      const double missed = unforeseen(life, times, bounds.until, warning);
      const int count = std::popcount(bits);
      if (missed > total || count > fewest ||
          !keeps_bound(risks_between(life, times, bounds.until), bounds.risk))
        continue;
      least = count < fewest ? missed : std::min(least, missed);
      fewest = count;
    }
    const InspectionTimes plan = fewest_for_total(life, bounds, total, warning, candidates);
    ASSERT_EQ(plan.stuck.has_value(), fewest > places);
    if (plan.stuck) continue;
    ++planned;
    ASSERT_EQ(plan.times.size(), static_cast<std::size_t>(fewest));
    EXPECT_NEAR(unforeseen(life, plan.times, bounds.until, warning), least, 1e-9);
  }
  EXPECT_GT(planned, 15);
}

}  // namespace
}  // namespace wearwell::plan
