#include "wearwell/prognosis/replacement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "prognosis/weibull_lives.h"
#include "wearwell/base/rng.h"
#include "wearwell/prognosis/warranty.h"

namespace wearwell::prognosis {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// ReliaSoft, System Analysis Reference, "Optimum Replacement Time Example": Weibull of shape 2.5 and scale 1000 h, 5 at
// failure, 1 before: 493.0470 h.
TEST(CheapestAge, IsThatOfReliaSoft) {
  const AgeReplacement best = cheapest_age(weibull_lives(2.5, 1000, 40000), {5, 1, 0});
  EXPECT_NEAR(best.age, 493.047, 2);
  EXPECT_LT(best.from, best.age);
  EXPECT_GT(best.to, best.age);
  EXPECT_FALSE(best.beyond_known);
}

// Barlow and Proschan: at the best age the hazard times what is lived until then, less the share that has failed, is c_p / (c_f
// - c_p), and the cost rate is (c_f - c_p) times the hazard.
TEST(CheapestAge, MeetsTheConditionOfBarlowAndProschan) {
  for (const double shape : {1.5, 2.0, 3.0, 5.0}) {
    for (const double failure : {3.0, 10.0, 50.0}) {
      const WeightedLives lives = weibull_lives(shape, 1, 40000);
      const AgeReplacement best = cheapest_age(lives, {failure, 1, 0});
      const double hazard = shape * std::pow(best.age, shape - 1);
      if (!std::isfinite(best.age)) continue;
      EXPECT_NEAR(best.rate / ((failure - 1) * hazard), 1, 0.02) << shape << " " << failure;
      EXPECT_NEAR((hazard * lives.mean_up_to(best.age) - lives.cdf(best.age)) * (failure - 1), 1,
                  0.03);
      EXPECT_NEAR(best.failing, 1 - std::exp(-std::pow(best.age, shape)), 1e-3);
    }
  }
}

// An exponential life does not age: replacement before failure is money lost.
TEST(CheapestAge, OfALifeWithoutAgeingIsNone) {
  const AgeReplacement best = cheapest_age(weibull_lives(1, 100), {10, 1, 0});
  EXPECT_EQ(best.age, never);
  EXPECT_NEAR(best.rate, 10 / 100., 1e-3);
  const AgeReplacement cheap_failure = cheapest_age(weibull_lives(4, 100), {1, 1, 0});
  EXPECT_EQ(cheap_failure.age, never);
}

TEST(CheapestAge, SaysWhereLivesEnd) {
  const WeightedLives lives(std::vector<double>{10, 20, 30, never},
                            std::vector<double>{1, 1, 1, 7});
  const AgeReplacement best = cheapest_age(lives, {2, 1, 0});
  EXPECT_TRUE(best.beyond_known);
  EXPECT_EQ(best.at_failure, 0);
}

// Thousands of units replaced by age, one after the other.
TEST(CostRate, IsWhatASimulationPays) {
  Rng rng(7, 0);
  const Costs costs{12, 2, 0};
  for (const double age : {0.3, 0.6, 1.2}) {
    double paid = 0, time = 0;
    for (int i = 0; i < 400000; ++i) {
      const double life = std::pow(-std::log(rng.uniform()), 1 / 2.5);
      paid += life < age ? costs.failure : costs.replacement;
      time += std::min(life, age);
    }
    EXPECT_NEAR(cost_rate(weibull_lives(2.5, 1), costs, age) / (paid / time), 1, 0.01) << age;
  }
}

// Where the population is not known its cost is a mean of costs, not the cost of a mean life.
TEST(CostRate, IsAveragedOverPopulations) {
  const WeightedLives shortened = weibull_lives(3, 1), lengthened = weibull_lives(3, 4);
  const PopulationLives both({shortened, lengthened}, {1, 3});
  const Costs costs{5, 1, 0};
  EXPECT_NEAR(cost_rate(both, costs, 0.8),
              0.25 * cost_rate(shortened, costs, 0.8) + 0.75 * cost_rate(lengthened, costs, 0.8),
              1e-12);
  const AgeReplacement best = cheapest_age(both, costs);
  EXPECT_GT(best.age, cheapest_age(shortened, costs).age);
  EXPECT_LT(best.age, cheapest_age(lengthened, costs).age);
  for (double age = 0.05; age < 6; age += 0.05)
    EXPECT_LE(best.rate, cost_rate(both, costs, age) * (1 + 1e-9)) << age;
}

// A posterior of many lives: populations that are almost alike.
PopulationLives alike(double shape, double scale) {
  std::vector<WeightedLives> each;
  for (int k = 0; k < 128; ++k) {
    const double eta = scale * (1 + 1e-5 * (k - 63.5));
    each.push_back(
        represented_lives([&](double p) { return eta * std::pow(-std::log1p(-p), 1 / shape); }));
  }
  return {std::move(each), std::vector<double>(128, 1)};
}

// Within what 330 points with straight lines between them give.
TEST(PopulationLives, WhereTheyAreAlikeHaveTheQuantilesOfOne) {
  for (const double shape : {1.2, 2.0, 3.0}) {
    const PopulationLives lives = alike(shape, 600);
    for (const double p : {0.001, 0.01, 0.02, 0.1, 0.103, 0.5, 0.9}) {
      const double known = 600 * std::pow(-std::log1p(-p), 1 / shape);
      EXPECT_NEAR(lives.quantile(p) / known, 1, 1e-3) << shape << " " << p;
      EXPECT_NEAR(lives.mixture().quantile(p) / known, 1, 1e-3) << shape << " " << p;
      EXPECT_NEAR(longest_warranty(lives, p).length / known, 1, 1e-3);
    }
  }
}

// Of 400 populations whose B2 is uniform over 1 to 2: the 5 % quantile with the standard error of so many draws.
TEST(LongestWarranty, OfPopulationsStatesTheErrorOfTheirNumber) {
  std::vector<WeightedLives> each;
  for (int k = 0; k < 400; ++k) {
    const double b2 = 1 + (k + 0.5) / 400, eta = b2 / std::sqrt(-std::log1p(-0.02));
    each.push_back(represented_lives([&](double p) { return eta * std::sqrt(-std::log1p(-p)); }));
  }
  const Warranty warranty =
      longest_warranty(PopulationLives(std::move(each), std::vector<double>(400, 1)), 0.02);
  EXPECT_EQ(warranty.populations, 400U);
  EXPECT_NEAR(warranty.sure, 1.05, 2e-3);
  EXPECT_NEAR(warranty.error.value(), std::sqrt(0.05 * 0.95 / 400) / 1.05, 1e-3);
}

// Where some never fail the quantiles beyond the others are infinite.
TEST(PopulationLives, OfWhichSomeNeverFail) {
  const WeightedLives ends(std::vector<double>{1, 2, 3}, std::vector<double>{1, 1, 1});
  const WeightedLives none(std::vector<double>{never}, std::vector<double>{1});
  const PopulationLives lives({ends, none}, {1, 1});
  EXPECT_NEAR(lives.quantile(0.25), 2, 1e-6);
  EXPECT_EQ(lives.quantile(0.6), never);
}

// R 4.2: for shape 2, scale 1000, 800 at failure, 120 before: the root of the derivative of the cost rate, and where the
// rate is 1 % above its least, by uniroot.
TEST(CheapestAge, ErrorsAreTwiceTheDifferenceFromFewerPoints) {
  AgeReplacement fine, coarse;
  fine.age = 100, coarse.age = 104;
  fine.rate = 2, coarse.rate = 1.99;
  estimate_errors(fine, coarse);
  EXPECT_NEAR(*fine.age_error, 0.08, 1e-12);
  EXPECT_NEAR(*fine.rate_error, 0.01, 1e-12);
  coarse.age = INFINITY;
  estimate_errors(fine, coarse);
  EXPECT_EQ(*fine.age_error, 2);
}

TEST(CheapestAge, HasTheRangeOfASmoothMinimum) {
  const AgeReplacement best = cheapest_age(alike(2, 1000), {800, 120, 0});
  EXPECT_NEAR(best.age, 426.4, 2);
  EXPECT_NEAR(best.from, 367.4, 1);
  EXPECT_NEAR(best.to, 496.3, 1);
}

// A unit of the fleet of which nothing is known but that it is new is replaced at the fleet's age.
TEST(CheapestMoment, OfANewUnitIsTheFleetsAge) {
  const WeightedLives lives = weibull_lives(2.5, 1000);
  const Costs costs{5, 1, 0};
  const AgeReplacement fleet = cheapest_age(lives, costs);
  const UnitReplacement one = cheapest_moment(lives, costs, fleet.rate);
  EXPECT_NEAR(one.after, fleet.age, 1e-3 * fleet.age);
  EXPECT_NEAR(one.cost, 0, 1e-9);  // in the mean it earns what the fleet does
  // ... and one that has come to some age, what is left of it; beyond that age, now.
  EXPECT_NEAR(cheapest_moment(lives.beyond(200), costs, fleet.rate).after, fleet.age - 200, 5);
  EXPECT_EQ(cheapest_moment(lives.beyond(700), costs, fleet.rate).after, 0);
}

// Without ageing the cost falls ever more slowly: at failure, not at a moment far in the tail.
TEST(CheapestMoment, IsAtFailureWhereTheCostIsFlat) {
  for (const double shape : {0.8, 1.0}) {
    const WeightedLives lives =
        represented_lives([&](double p) { return 1000 * std::pow(-std::log1p(-p), 1 / shape); });
    const Costs costs{20, 1, 0};
    const double rate = cheapest_age(lives, costs).rate;
    EXPECT_EQ(cheapest_moment(lives, costs, rate).after, never) << shape;
    EXPECT_EQ(cheapest_moment(lives.beyond(300), costs, rate).after, never) << shape;
  }
}

TEST(ReplacementByAge, IsTheFleetsAgeAndThenTheCheaperOfNowAndAtFailure) {
  const WeightedLives lives = weibull_lives(2.5, 1000);
  const Costs costs{5, 1, 0};
  const AgeReplacement fleet = cheapest_age(lives, costs);
  const auto of = [&](double now) {
    return replacement_by_age(lives, lives.beyond(now), costs, now, fleet.age);
  };
  EXPECT_NEAR(of(200).after, fleet.age - 200, 1e-9);
  EXPECT_NEAR(of(200).cost, moment_cost(lives.beyond(200), costs, fleet.rate, fleet.age - 200),
              1e-9);
  EXPECT_NEAR(of(200).failing, 1 - std::exp(std::pow(0.2, 2.5) - std::pow(fleet.age / 1000, 2.5)),
              1e-3);
  EXPECT_EQ(of(700).after, 0);
  EXPECT_EQ(of(700).cost, 1);
  EXPECT_EQ(of(700).failing, 0);
  EXPECT_GT(of(700).waiting, 1);
}

// Two populations: one wears out, one fails ever more rarely with age and outlives it. Beyond the age of least cost the
// survivors are of the second, whose fleet runs to failure: waiting costs c_f - c_f E[remaining]/E[life] < c_p.
TEST(ReplacementByAge, IsAtFailureWhereSurvivorsDoNotAge) {
  const auto weibull = [](double shape, double scale) {
    return represented_lives(
        [=](double p) { return scale * std::pow(-std::log1p(-p), 1 / shape); });
  };
  const PopulationLives fresh({weibull(4, 1000), weibull(0.5, 5000)}, {1, 1});
  const Costs costs{20, 1, 0};
  const double now = 3000;
  const WeightedLives left = weibull(0.5, 5000).beyond(now);
  const UnitReplacement best =
      replacement_by_age(fresh, {{{}, left}, {0, 1}}, costs, now, cheapest_age(fresh, costs).age);
  EXPECT_EQ(best.after, never);
  const double root =
      std::sqrt(now / 5000);  // E[N - now | N > now] = 2 eta (1 + root), E[N] = 2 eta
  EXPECT_NEAR(best.waiting, 20 - 20 * (1 + root), 0.2);
  EXPECT_NEAR(best.failing, 1, 1e-9);
}

TEST(CheapestMoment, IsTheLeastOfAll) {
  Rng rng(3, 0);
  for (int i = 0; i < 30; ++i) {
    std::vector<double> life, weight;
    for (int k = 0; k < 40; ++k) {
      life.push_back(rng.uniform(1, 50) * (rng.uniform() < 0.5 ? 1 : 4));
      weight.push_back(rng.uniform());
    }
    const WeightedLives lives(life, weight);
    const Costs costs{rng.uniform(1, 20), 1, 0};
    const double rate = rng.uniform(0.001, 0.3);
    const UnitReplacement best = cheapest_moment(lives, costs, rate);
    for (double after = 0; after < 210; after += 0.1)
      ASSERT_LE(best.cost, moment_cost(lives, costs, rate, after) + 2e-3) << after;
  }
}

}  // namespace
}  // namespace wearwell::prognosis
