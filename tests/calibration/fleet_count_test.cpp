// How many of a fleet reach their limit by a time, when the population was learned from 5 units of 5 readings: how often 90 %
// intervals of the number hold it, of 5 units that the study has seen and 25 new ones. Truths are drawn from the priors, where the share is
// 90 % by the laws of probability if all is right. WEARWELL_REPLICATIONS says how many populations.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "calibration/tracker_coverage.h"
#include "wearwell/base/rng.h"
#include "wearwell/prognosis/common_population.h"
#include "wearwell/prognosis/fleet_risk.h"

namespace wearwell::formula_model {
namespace {

constexpr double um = 1e-6, h = 3600, limit = 12 * um;
constexpr std::size_t learned = 5, fresh = 25, rows = 5;

struct Place {
  double together = NAN,
         alone = NAN;  // of the true number in what is said of it, evened out by chance
};

Place place_of(std::size_t number, const prognosis::Count& count, double chance, bool together,
               Place place) {
  double below = 0;
  for (std::size_t i = 0; i < number; ++i) below += count[i];
  (together ? place.together : place.alone) = below + chance * count[number];
  return place;
}

// One population; NaN where its posterior could not be integrated.
Place replication(std::uint64_t stream) {
  Rng rng(20261123, stream);
  std::vector<double> depth, time;
  std::vector<std::string> unit;
  for (std::size_t u = 0; u < learned; ++u) {
    for (std::size_t i = 1; i <= rows; ++i) {
      depth.push_back(static_cast<double>(i));
      time.push_back(static_cast<double>(i));
      unit.push_back("u" + std::to_string(u));
    }
  }
  const auto columns = [&] {
    return std::vector<Column>{numbers("depth", depth), numbers("time", time), texts("unit", unit)};
  };
  const std::vector<double> x = FormulaDesign(straight, columns()).from_priors(rng);
  std::vector<double> rate;
  for (std::size_t u = 0; u < learned + fresh; ++u)
    rate.push_back(x[0] * std::exp(x[1] * rng.normal()));
  for (std::size_t i = 0; i < depth.size(); ++i)
    depth[i] = (rate[i / rows] * time[i] * h + x[2] * rng.normal()) / um;
  const auto tracker = tracker_of(columns());
  if (!tracker) return {};
  prognosis::KnownLives lives = prognosis::lives_of_tracker(*tracker, "fit", true);
  const double after = tracker->begin("new")->forecast().remaining.quantile(0.4);
  for (std::size_t u = 0; u < fresh; ++u) {
    const std::string name = "new " + std::to_string(u);
    lives.units.push_back(prognosis::known_unit(name, tracker->begin(name)));
  }
  std::vector<const prognosis::KnownUnit*> units;
  std::size_t number = 0;
  for (std::size_t u = 0; u < lives.units.size(); ++u) {
    units.push_back(&lives.units[u]);
    number += rate[u] * (lives.units[u].now + after) >= limit;
  }
  const auto common = prognosis::in_common(lives, units, {&after, 1});
  EXPECT_TRUE(common.why.empty()) << common.why;
  std::vector<std::vector<double>> probability;
  for (const auto& each : common.failed) probability.push_back(each[0]);
  std::vector<double> alone;
  for (const prognosis::KnownUnit* each : units)
    alone.push_back(each->passed + (1 - each->passed) * each->remaining.cdf(after));
  const double chance = rng.uniform();
  const Place place =
      place_of(number, prognosis::how_many(probability, common.weight), chance, true, {});
  return place_of(number, prognosis::how_many(alone), chance, false, place);
}

TEST(FleetCount, HoldsAsOftenAsItSays) {
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  const int populations = wanted ? std::max(20, std::atoi(wanted)) : 300;
  std::vector<Place> places(static_cast<std::size_t>(populations));
  tbb::parallel_for(0, populations, [&](int p) {
    places[static_cast<std::size_t>(p)] = replication(static_cast<std::uint64_t>(p));
  });
  int count = 0, held = 0, alone = 0, few = 0, many = 0;
  for (const Place& each : places) {
    if (std::isnan(each.together)) continue;
    ++count;
    held += each.together >= 0.05 && each.together <= 0.95;
    few += each.together < 0.05;
    many += each.together > 0.95;
    alone += each.alone >= 0.05 && each.alone <= 0.95;
  }
  EXPECT_EQ(count, populations);
  const double error = std::sqrt(0.09 / count);
  std::printf(
      "number of 30 that reach the limit, %d populations: %.1f %% +- %.1f (fewer %.1f, more %.1f); "
      "as independent %.1f %%\n",
      count, 100.0 * held / count, 100 * error, 100.0 * few / count, 100.0 * many / count,
      100.0 * alone / count);
  std::fflush(stdout);
  EXPECT_NEAR(static_cast<double>(held) / count, 0.9, 0.01 + 3 * error);
  EXPECT_LT(static_cast<double>(alone) / count, 0.8);
}

}  // namespace
}  // namespace wearwell::formula_model
