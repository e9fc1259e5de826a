// The failures to come of units in service: closed forms, Monte Carlo, and the numbers of wearwell decide.
#include "wearwell/prognosis/fleet_outlook.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/rng.h"
#include "wearwell/math/constants.h"
#include "wearwell/prognosis/fleet_risk.h"
#include "wearwell/prognosis/survival_sweep.h"

namespace wearwell::prognosis {
namespace {

WeightedLives weibull(double scale, double shape) {
  return represented_lives([=](double p) { return scale * std::pow(-std::log1p(-p), 1 / shape); });
}

double survival(double t, double scale, double shape) {
  return std::exp(-std::pow(t / scale, shape));
}

struct Population {
  std::vector<double> scale, weight;
  double shape = 2;

  PopulationLives lives() const {
    PopulationLives all;
    all.weight = weight;
    for (const double each : scale) all.lives.push_back(weibull(each, shape));
    return all;
  }
};

// Sixty-one populations whose characteristic lives are lognormal about 1.
Population uncertain() {
  Population population;
  double sum = 0;
  for (int k = -30; k <= 30; ++k) {
    population.scale.push_back(std::exp(0.02 * k));
    sum += population.weight.emplace_back(std::exp(-0.5 * 0.01 * k * k));
  }
  for (double& each : population.weight) each /= sum;
  return population;
}

UnitsInService of_ages(std::vector<double> ages, bool in_study) {
  UnitsInService units;
  units.group.assign(ages.size(), 0);
  units.in_study.assign(ages.size(), in_study ? 1 : 0);
  units.age = std::move(ages);
  return units;
}

// A population in which no unit reaches this age has no weight, whether the study has the unit or not.
TEST(FleetOutlook, AUnitIsOfNoPopulationThatItHasOutlived) {
  const Population two{{0.1, 3}, {0.5, 0.5}};
  const Population last{{3}, {1}};
  const std::vector<PopulationLives> both = {two.lives()}, one = {last.lives()};
  const std::vector<double> horizons = {0.4};
  for (const bool in_study : {false, true}) {
    const FleetOutlook found = fleet_outlook(both, of_ages({1.2}, in_study), horizons);
    const FleetOutlook wanted = fleet_outlook(one, of_ages({1.2}, in_study), horizons);
    EXPECT_NEAR(found.failing[0][0], wanted.failing[0][0], 1e-12);
    EXPECT_NEAR(found.b10[0], wanted.b10[0], 1e-9);
    EXPECT_EQ(found.population.weight[0], 0);
    EXPECT_NEAR(found.failures[0].expected, wanted.failures[0].expected, 1e-12);
  }
}

TEST(FleetOutlook, HasTheClosedFormOfEachUnit) {
  const Population two{{1, 3}, {0.5, 0.5}};
  const std::vector<PopulationLives> groups = {two.lives()};
  const double age = 1.2, horizon = 0.4;
  for (const bool in_study : {false, true}) {
    const FleetOutlook outlook =
        fleet_outlook(groups, of_ages({age}, in_study), std::vector<double>{horizon});
    const auto failing = [&](double within) {
      double sum = 0, mass = 0;
      for (const double scale : two.scale) {
        const double before = survival(age, scale, 2);
        const double w = in_study ? 1 : before;
        mass += w;
        sum += w * (1 - survival(age + within, scale, 2) / before);
      }
      return sum / mass;
    };
    EXPECT_NEAR(outlook.failing[0][0], failing(horizon), 0.002);
    EXPECT_NEAR(failing(outlook.b10[0]), 0.1, 0.001);
    EXPECT_NEAR(failing(outlook.median[0]), 0.5, 0.002);
    EXPECT_NEAR(outlook.failures[0].expected, outlook.failing[0][0], 1e-12);
  }
}

// Populations drawn by weight, then the failures of each unit.
TEST(FleetOutlook, CountsAsMonteCarloDoes) {
  const Population population = uncertain();
  std::vector<double> ages;
  for (int i = 0; i < 600; ++i) ages.push_back(0.002 * (i % 300));
  const double horizon = 0.3;
  const std::vector<PopulationLives> groups = {population.lives()};
  const FleetOutlook outlook =
      fleet_outlook(groups, of_ages(ages, true), std::vector<double>{horizon});
  Rng rng(20, 1);
  constexpr int runs = 4000;
  std::vector<double> counts;
  for (int run = 0; run < runs; ++run) {
    double u = rng.uniform();
    std::size_t k = 0;
    while (k + 1 < population.weight.size() && (u -= population.weight[k]) > 0) ++k;
    double count = 0;
    for (const double age : ages)
      count += rng.uniform() < 1 - survival(age + horizon, population.scale[k], 2) /
                                       survival(age, population.scale[k], 2);
    counts.push_back(count);
  }
  const double mean = std::accumulate(counts.begin(), counts.end(), 0.0) / runs;
  double square = 0;
  for (const double each : counts) square += (each - mean) * (each - mean);
  const double error = std::sqrt(square / runs / runs);
  EXPECT_NEAR(outlook.failures[0].expected, mean, 4 * error + 0.002 * mean);
  const auto share_up_to = [&](double most) {
    return static_cast<double>(std::count_if(counts.begin(), counts.end(),
                                             [&](double each) { return each <= most; })) /
           runs;
  };
  const double noise = 4 * std::sqrt(0.05 * 0.95 / runs);
  EXPECT_GE(share_up_to(outlook.failures[0].low), 0.05 - noise);
  EXPECT_LE(share_up_to(outlook.failures[0].low - 1), 0.05 + noise);
  EXPECT_GE(share_up_to(outlook.failures[0].high), 0.95 - noise);
  EXPECT_LE(share_up_to(outlook.failures[0].high - 1), 0.95 + noise);
  // Counted as independent, it would be half as wide.
  double variance = 0;
  for (const double p : outlook.failing[0]) variance += p * (1 - p);
  EXPECT_GT(outlook.failures[0].high - outlook.failures[0].low, 2 * 3.29 * std::sqrt(variance));
}

// Small fleets are convolved, large ones have binomial distributions of the same moments.
TEST(FleetOutlook, SmallAndLargeFleetsAgree) {
  const std::vector<PopulationLives> groups = {uncertain().lives()};
  std::vector<double> ages;
  for (int i = 0; i < 390; ++i) ages.push_back(0.003 * (i % 130));
  std::vector<double> with_new = ages;
  with_new.resize(500, 0.0);
  const std::vector<double> horizon = {0.001};  // new ones hardly fail within
  const FleetOutlook exact = fleet_outlook(groups, of_ages(ages, true), horizon);
  const FleetOutlook large = fleet_outlook(groups, of_ages(with_new, true), horizon);
  EXPECT_NEAR(exact.failures[0].expected, large.failures[0].expected, 1e-3);
  EXPECT_NEAR(exact.failures[0].low, large.failures[0].low, 1);
  EXPECT_NEAR(exact.failures[0].high, large.failures[0].high, 1);
}

TEST(FleetOutlook, BetweenAgesItIsAsExactAsAtThem) {
  const std::vector<PopulationLives> groups = {uncertain().lives()};
  std::vector<double> ages;
  for (int i = 0; i < 5000; ++i) ages.push_back(2.0 * std::pow(i / 5000.0, 3));
  const std::vector<double> horizons = {0.05, 0.5};
  const FleetOutlook all = fleet_outlook(groups, of_ages(ages, false), horizons);
  EXPECT_TRUE(all.interpolated);
  double probability = 0, b10 = 0;
  for (std::size_t u = 7; u < ages.size(); u += 331) {
    const FleetOutlook one = fleet_outlook(groups, of_ages({ages[u]}, false), horizons);
    EXPECT_FALSE(one.interpolated);
    for (std::size_t h = 0; h < 2; ++h)
      probability = std::max(probability, std::abs(all.failing[h][u] - one.failing[h][0]));
    b10 = std::max(b10, std::abs(all.b10[u] / one.b10[0] - 1));
  }
  EXPECT_LT(probability, 1e-4);
  EXPECT_LT(b10, 1e-3);
}

// Survival of many is evidence on the population; of too many, more than its points resolve.
TEST(FleetOutlook, SurvivalOfAllIsEvidenceAsFarAsItIsResolved) {
  const Population population = uncertain();
  const std::vector<PopulationLives> groups = {population.lives()};
  const std::vector<double> horizon = {0.2};
  const auto with = [&](std::size_t units, bool in_study) {
    return fleet_outlook(groups, of_ages(std::vector<double>(units, 0.7), in_study), horizon);
  };
  const FleetOutlook few = with(3, false);
  EXPECT_TRUE(few.population.resolved);
  EXPECT_LT(few.failures[0].expected, with(3, true).failures[0].expected);
  double sum = 0, mass = 0;
  for (std::size_t k = 0; k < population.scale.size(); ++k) {
    const double before = survival(0.7, population.scale[k], 2);
    const double w = population.weight[k] * std::pow(before, 3);
    mass += w;
    sum += w * 3 * (1 - survival(0.9, population.scale[k], 2) / before);
  }
  EXPECT_NEAR(few.failures[0].expected, sum / mass, 0.005 * sum / mass);
  const FleetOutlook many = with(100'000, false);
  EXPECT_FALSE(many.population.resolved);
  EXPECT_NEAR(many.failures[0].expected / with(100'000, true).failures[0].expected, 1, 1e-12);
}

TEST(FleetOutlook, SomeNeverFail) {
  PopulationLives half(
      {WeightedLives(std::vector<double>{1, 2, 3, infinity}, std::vector<double>{1, 1, 1, 4})},
      {1});
  const std::vector<PopulationLives> groups = {half};
  const FleetOutlook outlook =
      fleet_outlook(groups, of_ages({0.5}, false), std::vector<double>{1, 100});
  EXPECT_TRUE(std::isinf(outlook.median[0]));
  EXPECT_NEAR(outlook.failing[1][0], 3.0 / 7, 1e-12);
  EXPECT_TRUE(some_survive(half, 100));
  EXPECT_FALSE(some_survive(PopulationLives(weibull(1, 2)), 100));
}

TEST(SurvivalSweep, IsTheSurvivalAtEachPlace) {
  PopulationLives lives = uncertain().lives();
  lives.lives.push_back(WeightedLives(std::vector<double>{0, 0.5, 0.5, 2, infinity},
                                      std::vector<double>{1, 2, 1, 2, 1}));
  lives.lives.emplace_back();  // no unit is left of it
  lives.weight.insert(lives.weight.end(), {0.3, 0.1});
  std::vector<double> places;
  for (int i = 0; i <= 500; ++i) places.push_back(0.01 * i);
  const std::vector<double> swept = survivals(lives, places);
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_NEAR(swept[i], lives.survival(places[i]), 1e-13) << places[i];
}

}  // namespace
}  // namespace wearwell::prognosis
