// How many of a fleet, where units share a population that is not known exactly: against Monte Carlo over its nodes, and whether
// intervals of the number hold as often as they say.
#include "wearwell/prognosis/common_population.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/prognosis/decisions.h"
#include "wearwell/prognosis/fleet_risk.h"

namespace wearwell::prognosis {
namespace {

// Lives of median exp(theta), lognormal, as points.
WeightedLives lognormal(double theta, double spread) {
  std::vector<double> life, weight;
  for (int i = -60; i <= 60; ++i) {
    const double z = 0.1 * i;
    life.push_back(std::exp(theta + spread * z));
    weight.push_back(std::exp(-0.5 * z * z));
  }
  return {life, weight};
}

constexpr double spread = 0.3;

// Units of ages that differ, all of one population of which theta is normal about 0 with this sd.
struct Fleet {
  std::vector<double> theta;
  KnownLives lives;

  Fleet(std::size_t units, double sd) {
    for (int k = -40; k <= 40; ++k) {
      theta.push_back(sd * 0.1 * k);
      lives.populations.push_back(std::exp(-0.005 * k * k));
    }
    double sum = 0;
    for (const double each : lives.populations) sum += each;
    for (double& each : lives.populations) each /= sum;
    for (std::size_t u = 0; u < units; ++u)
      add(0.5 * static_cast<double>(u) / static_cast<double>(units));
  }

  void add(double age) {
    const std::size_t count = theta.size();
    InPopulations unit{std::vector<double>(count), std::vector<double>(count), {}};
    std::vector<double> life, weight;
    for (std::size_t k = 0; k < count; ++k) {
      unit.remaining.push_back(lognormal(theta[k], spread).beyond(age));
      const auto points = unit.remaining.back().points(), shares = unit.remaining.back().weights();
      for (std::size_t i = 0; i < points.size(); ++i) {
        life.push_back(points[i]);
        weight.push_back(lives.populations[k] * shares[i]);
      }
    }
    lives.units.push_back(
        {"u", 0, 0, WeightedLives(life, weight), [unit] { return std::optional(unit); }});
  }

  std::vector<const KnownUnit*> units() const {
    std::vector<const KnownUnit*> all;
    for (const KnownUnit& each : lives.units) all.push_back(&each);
    return all;
  }
  CommonPopulation at(double after) const { return in_common(lives, units(), {&after, 1}); }
};

Count counted(const CommonPopulation& common) {
  std::vector<std::vector<double>> probability;
  for (const auto& each : common.failed) probability.push_back(each[0]);
  return how_many(probability, common.weight);
}

// The same without what units share.
Count counted_alone(const Fleet& fleet, double after) {
  std::vector<double> probability;
  for (const KnownUnit& each : fleet.lives.units) probability.push_back(each.remaining.cdf(after));
  return how_many(probability);
}

std::size_t drawn(const std::vector<double>& weight, Rng& rng) {
  double left = rng.uniform();
  std::size_t k = 0;
  while (k + 1 < weight.size() && (left -= weight[k]) > 0) ++k;
  return k;
}

TEST(CommonPopulation, IsMonteCarloOverPopulations) {
  const Fleet fleet(30, 0.3);
  const CommonPopulation common = fleet.at(0.6);
  EXPECT_EQ(common.weight.size(), 81u);
  EXPECT_TRUE(common.why.empty());
  const Count exact = counted(common);
  Rng rng(5, 0);
  constexpr int draws = 200'000;
  std::vector<int> seen(31);
  for (int d = 0; d < draws; ++d) {
    const std::size_t k = drawn(fleet.lives.populations, rng);
    std::size_t failed = 0;
    for (const double p : common.failed[k][0]) failed += rng.uniform() < p;
    ++seen[failed];
  }
  double chi_squared = 0;
  int bins = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double error = std::sqrt(exact[i] * (1 - exact[i]) / draws);
    const double off = static_cast<double>(seen[i]) / draws - exact[i];
    EXPECT_LT(std::abs(off), 4.5 * error + 1e-5) << i;
    if (exact[i] * draws < 10) continue;
    chi_squared += off * off / (exact[i] / draws);
    ++bins;
  }
  EXPECT_LT(chi_squared, bins + 4 * std::sqrt(2.0 * bins));
}

// Means do not know what units share, spreads do.
TEST(CommonPopulation, KeepsTheMeanAndWidensTheSpread) {
  const Fleet fleet(30, 0.3);
  const Count together = counted(fleet.at(0.6)), alone = counted_alone(fleet, 0.6);
  EXPECT_NEAR(mean(together), mean(alone), 0.02);
  EXPECT_GT(sd(together), 1.8 * sd(alone));
}

// The place of the truth among the numbers, evened out where several are as likely; 5 to 95 % hold it 90 % of the time.
TEST(CommonPopulation, HoldsAsOftenAsItSays) {
  const Fleet fleet(40, 0.3);
  const double after = 0.7;
  const Count together = counted(fleet.at(after)), alone = counted_alone(fleet, after);
  Rng rng(6, 0);
  constexpr int replications = 4000;
  int held = 0, held_alone = 0;
  for (int r = 0; r < replications; ++r) {
    const double theta = 0.3 * rng.normal();
    std::size_t failed = 0;
    for (std::size_t u = 0; u < 40; ++u) {
      const double age = 0.5 * static_cast<double>(u) / 40;
      // One that has lived until now.
      const double before = normal_cdf((std::log(std::max(age, 1e-12)) - theta) / spread);
      const double by = normal_cdf((std::log(age + after) - theta) / spread);
      failed += rng.uniform() < (by - before) / (1 - before);
    }
    const double at = rng.uniform();
    const auto inside = [&](const Count& count) {
      double below = 0;
      for (std::size_t i = 0; i < failed; ++i) below += count[i];
      const double place = below + at * count[failed];
      return place > 0.05 && place < 0.95;
    };
    held += inside(together);
    held_alone += inside(alone);
  }
  const double share = static_cast<double>(held) / replications;
  const double share_alone = static_cast<double>(held_alone) / replications;
  RecordProperty("held", std::to_string(share));
  RecordProperty("held_if_independent", std::to_string(share_alone));
  EXPECT_NEAR(share, 0.9, 4 * std::sqrt(0.09 / replications) + 0.003);
  EXPECT_LT(share_alone, 0.6);
}

// What units have shown moves the population of all.
TEST(CommonPopulation, IsWeighedByWhatAllUnitsShow) {
  Fleet fleet(5, 0.3);
  for (KnownUnit& each : fleet.lives.units) {
    InPopulations unit = *each.in_populations();
    for (std::size_t k = 0; k < unit.log_likelihood.size(); ++k)
      unit.log_likelihood[k] = -0.5 * std::pow((fleet.theta[k] - 0.2) / 2, 2);
    each.in_populations = [unit] { return std::optional(unit); };
  }
  const CommonPopulation common = fleet.at(0.6);
  ASSERT_TRUE(common.why.empty());
  double mean_of = 0, square = 0;
  for (std::size_t k = 0; k < fleet.theta.size(); ++k) {
    mean_of += common.weight[k] * fleet.theta[k];
    square += common.weight[k] * fleet.theta[k] * fleet.theta[k];
  }
  // Normal with precision 1/0.3^2 + 5/2^2.
  const double precision = 1 / 0.09 + 5 / 4.0;
  EXPECT_NEAR(mean_of, 5 / 4.0 * 0.2 / precision, 1e-4);
  EXPECT_NEAR(square - mean_of * mean_of, 1 / precision, 1e-3 / precision);
}

TEST(CommonPopulation, SaysWhereItCannotBeTold) {
  Fleet fleet(5, 0.3);
  const Count alone = counted_alone(fleet, 0.6);
  const auto expect_alone = [&](bool outgrown, const char* why) {
    const CommonPopulation common = fleet.at(0.6);
    EXPECT_EQ(common.outgrown, outgrown);
    EXPECT_NE(common.why.find(why), std::string::npos) << common.why;
    EXPECT_EQ(counted(common), alone);
  };
  // Readings that leave a few populations only.
  const auto as_it_was = fleet.lives.units[0].in_populations;
  fleet.lives.units[0].in_populations = [&] {
    InPopulations unit = *as_it_was();
    for (std::size_t k = 0; k < unit.log_likelihood.size(); ++k)
      unit.log_likelihood[k] = -0.5 * std::pow(fleet.theta[k] / 0.01, 2);
    return std::optional(unit);
  };
  expect_alone(true, "81 points resolve");
  fleet.lives.units[0].in_populations = [] { return std::optional<InPopulations>(); };
  expect_alone(true, "no forecast by population");
  fleet.lives.populations.clear();
  expect_alone(false, "do not separate");
}

}  // namespace
}  // namespace wearwell::prognosis
