// Units on line against sums over dense grids, against what a fit says of units that it has seen, and against
// themselves: in another order, from saved states, laid anew again and again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/tracker_coverage.h"
#include "models/formula_model/watched.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/formula_model/formula_first_passage.h"
#include "wearwell/prognosis/information.h"

namespace wearwell::formula_model {
namespace {

using prognosis::Forecast;
using prognosis::UpdateResult;

std::vector<Column> lines(const std::vector<double>& rate, int rows, double noise) {
  std::vector<double> depth, time;
  std::vector<std::string> unit;
  Rng rng(7, 0);
  for (std::size_t u = 0; u < rate.size(); ++u) {
    for (int i = 1; i <= rows; ++i) {
      time.push_back(i);
      depth.push_back(rate[u] * i + noise * rng.normal());
      unit.push_back("u" + std::to_string(u));
    }
  }
  return {numbers("depth", depth), numbers("time", time), texts("unit", unit)};
}

const std::vector<double> rates = {0.8, 1.3, 1.0, 0.6, 1.1};

TEST(FormulaTracker, ASmallCaseByBruteForce) {
  const std::vector<std::vector<double>> x = {
      {1 * um / h, 0.3, 0.3 * um}, {1.2 * um / h, 0.5, 0.2 * um}, {0.9 * um / h, 0.2, 0.4 * um}};
  const Watched watched(straight, lines(rates, 5, 0.3), points(x));
  FollowedUnit unit(*watched.tracker, "new");
  const std::vector<std::pair<double, double>> readings = {
      {1.9 * um, 1 * h}, {3.4 * um, 2 * h}, {3.7 * um, 2 * h}, {5.0 * um, 3 * h}};
  for (std::size_t shown = 0; shown <= readings.size(); ++shown) {
    if (shown > 0) {
      EXPECT_TRUE(unit.update({readings[shown - 1].first, readings[shown - 1].second}).counted);
    }
    const Forecast forecast = unit.unit->forecast();
    std::vector<std::pair<double, double>> lives;
    double sum = 0, passed = 0;
    const double now = shown == 0 ? 0 : readings[shown - 1].second;
    for (const auto& each : x) {
      for (double z = -8; z <= 8; z += 0.001) {
        const double b = each[0] * std::exp(each[1] * z);
        double log_f = -0.5 * z * z;
        for (std::size_t i = 0; i < shown; ++i) {
          const double off = (readings[i].first - b * readings[i].second) / each[2];
          log_f -= 0.5 * off * off + std::log(each[2] / um);
        }
        sum += std::exp(log_f);
        if (12 * um / b <= now) {
          passed += std::exp(log_f);
        } else {
          lives.emplace_back(12 * um / b - now, std::exp(log_f));
        }
      }
    }
    std::sort(lives.begin(), lives.end());
    EXPECT_NEAR(forecast.passed, passed / sum, 2e-3);
    // Three points of the posterior alone: their lines have 16 nodes each, no more.
    double below = 0;
    for (const auto& [life, weight] : lives) {
      const double before = below;
      below += weight / (sum - passed);
      for (const double p : {0.05, 0.5, 0.95}) {
        if (before < p && below >= p) {
          EXPECT_NEAR(forecast.remaining.cdf(life), p, 0.02) << shown;
        }
      }
    }
  }
}

// Of 4 um that a repair takes back: a straight path reaches 12 + 4 um at 16/12 of its life without,
// and its readings are what it would have without the repair.
TEST(FormulaTracker, ARepairMovesTheThresholdAndTheLevels) {
  std::string process = straight;
  const auto change = [&](const std::string& from, const std::string& to) {
    process.replace(process.find(from), from.size(), to);
  };
  change("[formula]\nwear = \"b * time\"\n", "");
  change("\"normal\"", "\"gamma-process\"");
  change("mean = \"wear\"\nsd", "mean = \"b * time\"\nscale");
  change("limit = { wear", "limit = { depth");
  for (const std::string& study : {std::string(straight), process}) {
    const Watched watched(study, lines(rates, 5, 0.1),
                          points({{1 * um / h, 0.3, 0.3 * um}, {1.2 * um / h, 0.5, 0.2 * um}}));
    ASSERT_TRUE(watched.tracker->can_be_restored());
    FollowedUnit never(*watched.tracker, "new"), repaired(*watched.tracker, "new");
    repaired.unit->set_restored(4 * um);
    for (const auto& [depth, time] : {std::pair{3.1, 3.0}, {6.0, 6.0}, {9.2, 9.0}}) {
      never.update({depth * um, time * h});
      repaired.update({depth * um, time * h});
    }
    const Forecast a = never.unit->forecast(), b = repaired.unit->forecast();
    EXPECT_NEAR(b.level50, a.level50 - 4 * um, 1e-12);
    EXPECT_NEAR(b.level95, a.level95 - 4 * um, 1e-12);
    const double places[] = {a.now, a.now + 2 * h};
    const auto ahead_a = never.unit->ahead(places), ahead_b = repaired.unit->ahead(places);
    EXPECT_NEAR(ahead_b[1].level05, ahead_a[1].level05 - 4 * um, 1e-12);
    if (study == straight) {
      const auto by = [](const Forecast& of, double at) {
        return of.passed + (1 - of.passed) * of.remaining.cdf(at - of.now);
      };
      for (const double life : {13.0, 14.0, 15.0, 16.0, 17.0, 19.0})
        EXPECT_NEAR(by(b, life * h), by(a, 12.0 / 16 * life * h), 0.01) << life;
    } else {
      EXPECT_GT(b.remaining.quantile(0.5), a.remaining.quantile(0.5) + 2 * h);
    }
    // A state that was saved without it goes on with it.
    const auto restored = watched.tracker->restore(repaired.unit->save());
    restored->set_restored(4 * um);
    EXPECT_EQ(restored->forecast().remaining.quantile(0.5), b.remaining.quantile(0.5));
    repaired.unit->set_restored(0);
    EXPECT_EQ(repaired.unit->forecast().remaining.quantile(0.5), a.remaining.quantile(0.5));
  }
}

// `predictive` looks at some nodes where `update` looks at all, `quantiles` does not sort all lives.
TEST(FormulaTracker, ShortWaysHaveTheSameNumbers) {
  const Watched watched(straight, lines(rates, 5, 0.3),
                        points({{1 * um / h, 0.3, 0.3 * um}, {1.2 * um / h, 0.5, 0.2 * um}}));
  FollowedUnit unit(*watched.tracker, "new");
  double least = 1;
  for (const auto& [depth, time] : {std::pair{1.9, 1.0},
                                    {3.4, 2.0},
                                    {5.9, 3.0},
                                    {3.2, 4.0},
                                    {9.8, 8.0},
                                    {12.5, 9.0},
                                    {30.0, 20.0}}) {
    const prognosis::Reading reading{{depth * um, time * h}, {}};
    const std::vector<prognosis::PredictiveTails> before = unit.unit->predictive(reading);
    const UpdateResult taken = unit.update(reading.numbers);
    ASSERT_TRUE(before.size() == 1 && taken.tails.size() == 1);
    EXPECT_EQ(before[0].below, taken.tails[0].below);
    EXPECT_EQ(before[0].above, taken.tails[0].above);
    least = std::min(least, taken.p_value);
    const prognosis::ForecastQuantiles one = unit.unit->quantiles(),
                                       other = quantiles_of(unit.unit->forecast());
    for (const auto of :
         {&prognosis::ForecastQuantiles::now, &prognosis::ForecastQuantiles::level05,
          &prognosis::ForecastQuantiles::level95, &prognosis::ForecastQuantiles::passed,
          &prognosis::ForecastQuantiles::remaining05, &prognosis::ForecastQuantiles::remaining50,
          &prognosis::ForecastQuantiles::remaining95})
      EXPECT_NEAR(one.*of, other.*of, 1e-9 * std::abs(other.*of)) << time;
  }
  EXPECT_LT(least, 0.01);                            // summed over all nodes
  EXPECT_EQ(unit.unit->quantiles().remaining95, 0);  // nothing is left
}

// b of the unit is all that is not known of a straight path: level(t) = b t.
TEST(FormulaTracker, ThePathAheadByBruteForce) {
  const std::vector<double> x = {1 * um / h, 0.3, 0.3 * um};
  const Watched watched(straight, lines(rates, 5, 0.3),
                        points(std::vector<std::vector<double>>(40, x)));
  FollowedUnit unit(*watched.tracker, "new");
  const std::vector<std::pair<double, double>> readings = {{1.9 * um, 1 * h}, {3.4 * um, 2 * h}};
  for (const auto& [depth, time] : readings) unit.update({depth, time});
  std::vector<std::pair<double, double>> rate;
  double sum = 0;
  for (double z = -8; z <= 8; z += 0.001) {
    const double b = x[0] * std::exp(x[1] * z);
    double log_f = -0.5 * z * z;
    for (const auto& [depth, time] : readings) {
      const double off = (depth - b * time) / x[2];
      log_f -= 0.5 * off * off;
    }
    rate.emplace_back(b, std::exp(log_f));
    sum += std::exp(log_f);
  }
  const double places[] = {2 * h, 3 * h, 7 * h, 20 * h};
  for (const prognosis::ForecastBand& each : unit.unit->ahead(places)) {
    double below = 0;
    for (const auto& [b, weight] : rate) {
      const double before = below;
      below += weight / sum;
      for (const auto& [p, level] :
           {std::pair(0.05, each.level05), {0.5, each.level50}, {0.95, each.level95}}) {
        if (before < p && below >= p) {
          EXPECT_NEAR(level, b * each.at, 2e-3 * b * each.at) << p;
        }
      }
    }
  }
  const double behind[] = {1.9 * h};
  EXPECT_THROW(unit.unit->ahead(behind), std::invalid_argument);
  expect_path_ahead(*watched.tracker, *unit.unit, false);
}

// A reading far ahead may show what the path there may be, not what it is today: 3 um now, some 350 um at 200 h.
TEST(FormulaTracker, ReadingsFarAheadAreOfThePathThere) {
  const Watched watched(straight, lines(rates, 5, 0.3),
                        points(std::vector<std::vector<double>>(40, {1 * um / h, 0.3, 0.3 * um})));
  FollowedUnit unit(*watched.tracker, "new");
  const std::vector<std::pair<double, double>> readings = {{1.9 * um, 1 * h}, {3.4 * um, 2 * h}};
  for (const auto& [depth, time] : readings) unit.update({depth, time});
  const prognosis::History history = [&](const auto& visit) {
    for (const auto& [depth, time] : readings) visit({{depth, time}, {}});
  };
  const double place[] = {200 * h};
  const prognosis::ForecastBand band = unit.unit->ahead(place).front();
  const auto outcomes = prognosis::possible_outcomes(*watched.tracker, *unit.unit,
                                                     {{std::nan(""), place[0]}, {}}, 0, history);
  ASSERT_EQ(outcomes.size(), 40u);
  // The strata end at 5, 50 and 95 %; noise of 0.3 um adds nothing to a band of tens.
  EXPECT_NEAR(0.5 * (outcomes[1].reading + outcomes[2].reading), band.level05, 0.02 * band.level05);
  EXPECT_NEAR(0.5 * (outcomes[19].reading + outcomes[20].reading), band.level50,
              0.01 * band.level50);
  EXPECT_NEAR(0.5 * (outcomes[37].reading + outcomes[38].reading), band.level95,
              0.02 * band.level95);
}

// Nothing but the chance of the increments to come: normal about b t, gamma with mean b t; variance s b t.
TEST(FormulaTracker, ThePathAheadOfAProcess) {
  for (const std::string family : {"wiener", "gamma"}) {
    SCOPED_TRACE(family);
    std::string study = straight;
    const auto change = [&](const std::string& from, const std::string& to) {
      study.replace(study.find(from), from.size(), to);
    };
    change("[formula]\nwear = \"b * time\"\n", "");
    change("\"normal\"", "\"" + family + "-process\"");
    change("mean = \"wear\"\nsd", "mean = \"b * time\"\nscale");
    change("limit = { wear", "limit = { depth");
    const double b = 1 * um / h, s = 0.2 * um;
    const Watched watched(study, lines(rates, 5, 0.1),
                          points(std::vector<std::vector<double>>(200, {b, 1e-6, s})));
    FollowedUnit unit(*watched.tracker, "new");
    ASSERT_TRUE(unit.update({3 * um, 3 * h}).counted);
    const double places[] = {3 * h, 4 * h, 9 * h};
    const std::vector<prognosis::ForecastBand> path = unit.unit->ahead(places);
    EXPECT_NEAR(path[0].level05, 3 * um, 1e-9 * um);
    EXPECT_NEAR(path[0].level95, 3 * um, 1e-9 * um);
    for (const int i : {1, 2}) {
      const double grown = b * (places[i] - 3 * h), sd = std::sqrt(s * grown);
      const auto expected = [&](double p) {
        return 3 * um + increment_quantile(family == "gamma" ? Process::gamma : Process::wiener,
                                           grown, s, p);
      };
      EXPECT_NEAR(path[i].level05, expected(0.05), 0.02 * sd);
      EXPECT_NEAR(path[i].level50, expected(0.5), 0.02 * sd);
      EXPECT_NEAR(path[i].level95, expected(0.95), 0.02 * sd);
    }
    expect_path_ahead(*watched.tracker, *unit.unit, family == "wiener");
  }
}

// Of units of the population, each read three times, nine of ten are within the bands later on.
TEST(FormulaTracker, BandsAheadHold) {
  const double b = 1 * um / h, scatter = 0.3, sigma = 0.3 * um;
  const Watched watched(straight, lines(rates, 5, 0.3),
                        points(std::vector<std::vector<double>>(40, {b, scatter, sigma})));
  Rng rng(29, 0);
  constexpr int units = 1000;
  int held[2] = {};
  for (int u = 0; u < units; ++u) {
    const double own = b * std::exp(scatter * rng.normal());
    FollowedUnit unit(*watched.tracker, "new");
    for (int i = 1; i <= 3; ++i) {
      ASSERT_TRUE(unit.update({own * i * 0.5 * h + sigma * rng.normal(), i * 0.5 * h}).counted);
    }
    const double places[] = {3 * h, 10 * h};
    const std::vector<prognosis::ForecastBand> path = unit.unit->ahead(places);
    for (int k = 0; k < 2; ++k) {
      held[k] += path[k].level05 <= own * places[k] && own * places[k] <= path[k].level95;
    }
  }
  for (const int each : held) EXPECT_NEAR(each, 0.9 * units, 3 * std::sqrt(units * 0.09));
}

TEST(FormulaTracker, UnitsThatTheStudyHasSeenAreAsTheFitSaysOfThem) {
  const Watched watched(straight, lines(rates, 5, 0.3));
  const LimitedLives fit = lives_of_fit(watched, watched.fitted());
  for (std::size_t u = 0; u < rates.size(); ++u) {
    const auto unit = watched.tracker->begin("u" + std::to_string(u));
    expect_alike(unit->forecast(), fit.remaining[u], fit.passed[u], 4e-3);
  }
}

// The last rows of a unit held back, and given one by one: population and unit are then as if all had been fitted.
TEST(FormulaTracker, FollowingAUnitIsFittingItsRowsToo) {
  const std::vector<Column> all = lines({0.8, 1.3, 1.0, 0.6, 1.1, 1.7}, 5, 0.3);
  std::vector<Column> known = all;
  for (Column& each : known) {
    if (each.is_number)
      each.numbers.resize(25);
    else
      each.text.resize(25);
  }
  const Watched whole(straight, all), part(straight, known);
  FollowedUnit unit(*part.tracker, "u5");
  for (std::size_t i = 25; i < 30; ++i) {
    const UpdateResult taken = unit.update({all[0].numbers[i] * um, all[1].numbers[i] * h});
    EXPECT_TRUE(taken.counted);
    EXPECT_FALSE(taken.contradicts);
  }
  const LimitedLives fit = lives_of_fit(whole, whole.fitted());
  expect_alike(unit.unit->forecast(), fit.remaining[5], fit.passed[5], 6e-3);
}

TEST(FormulaTracker, SavedStatesGoOnWithTheSameBits) {
  const Watched watched(straight, lines(rates, 5, 0.3));
  FollowedUnit unit(*watched.tracker, "new"), other(*watched.tracker, "new");
  for (int i = 1; i <= 12; ++i) {
    const std::vector<double> reading = {(0.9 * i + 0.2 * std::sin(i)) * um, i * h};
    unit.update(reading);
    other.update(reading);
    const std::string bytes = unit.unit->save();
    EXPECT_EQ(bytes, other.unit->save());
    other.unit = watched.tracker->restore(bytes);
    EXPECT_EQ(bytes, other.unit->save());
    EXPECT_EQ(unit.unit->forecast().remaining.quantile(0.1),
              other.unit->forecast().remaining.quantile(0.1));
    std::string damaged = bytes;
    damaged[bytes.size() / 2] ^= 1;
    EXPECT_THROW(watched.tracker->restore(damaged), InputError);
  }
  std::printf("state of a unit: %zu bytes\n", unit.unit->save().size());
  const Watched another(straight, lines({0.8, 1.3, 1.0, 0.6, 1.2}, 5, 0.3));
  EXPECT_THROW(another.tracker->restore(unit.unit->save()), InputError);
}

TEST(FormulaTracker, TheOrderOfReadingsDoesNotMatter) {
  const Watched watched(straight, lines(rates, 5, 0.3));
  std::vector<std::vector<double>> readings;
  for (int i = 1; i <= 20; ++i)
    readings.push_back({(0.36 * i + 0.3 * std::sin(7.0 * i)) * um, 0.4 * i * h});
  FollowedUnit in_order(*watched.tracker, "new"), reversed(*watched.tracker, "new");
  for (const auto& each : readings) in_order.update(each);
  std::reverse(readings.begin(), readings.end());
  for (const auto& each : readings) reversed.update(each);
  const Forecast a = in_order.unit->forecast(), b = reversed.unit->forecast();
  EXPECT_EQ(a.now, b.now);
  for (const double p : {0.05, 0.5, 0.95}) {
    EXPECT_NEAR(b.remaining.cdf(a.remaining.quantile(p)), p, 0.02);
  }
}

// Ever more readings: nodes are laid anew again and again, parameters that all share are learned from it.
TEST(FormulaTracker, ManyReadingsOfOneUnit) {
  const Watched watched(straight, lines(rates, 5, 0.3));
  FollowedUnit unit(*watched.tracker, "new");
  Rng rng(3, 0);
  for (int i = 1; i <= 400; ++i) {
    const double t = 0.025 * i;
    const UpdateResult taken = unit.update({(1.05 * t + 0.25 * rng.normal()) * um, t * h});
    ASSERT_TRUE(taken.counted) << taken.problem;
    ASSERT_FALSE(taken.contradicts) << taken.p_value;
  }
  const Forecast forecast = unit.unit->forecast();
  std::printf("effective after 400: %.1f, life %.4g .. %.4g h\n", forecast.effective,
              forecast.remaining.quantile(0.05) / h, forecast.remaining.quantile(0.95) / h);
  // The unit's own line by least squares, all else is known well by now.
  EXPECT_NEAR(forecast.remaining.quantile(0.5), (12 / 1.05 - 10) * h, 0.1 * h);
  EXPECT_GT(forecast.effective, 50);
}

// What tests/calibration does with 2,000 units of as many populations.
TEST(FormulaTracker, IntervalsHoldTheTruth) {
  const TrackedCoverage coverage = tracked_coverage({}, 12, 12, 500);
  EXPECT_EQ(coverage.failed, 0);
  for (const auto& each : coverage.of) {
    EXPECT_GT(each.units, 100);
    EXPECT_NEAR(each.share(), 0.9, 0.08);
  }
}

TEST(FormulaTracker, WhatCannotBeTaken) {
  const Watched watched(straight, lines(rates, 5, 0.3));
  FollowedUnit unit(*watched.tracker, "new");
  EXPECT_EQ(unit.update({NAN, 1 * h}).problem, "depth is missing");
  EXPECT_EQ(unit.update({1 * um, NAN}).problem, "time is missing");
  EXPECT_EQ(unit.update({INFINITY, 1 * h}).problem, "depth is not finite");
  EXPECT_THROW(unit.update({1 * um}), InputError);
  EXPECT_EQ(unit.update({1 * um, -0.5 * h}).problem,
            "time = -0.5 h lies before 0, the start of paths");
  EXPECT_TRUE(unit.update({1 * um, 1 * h}).counted);
  const UpdateResult far = unit.update({40 * um, 2 * h});
  EXPECT_TRUE(far.counted);
  EXPECT_TRUE(far.contradicts);
  EXPECT_LT(far.p_value, 1e-4);
}

// One that no path can go through leaves the unit as it was.
TEST(FormulaTracker, AProcessThatOnlyRises) {
  std::string study = straight;
  const auto change = [&](const std::string& from, const std::string& to) {
    study.replace(study.find(from), from.size(), to);
  };
  change("[formula]\nwear = \"b * time\"\n", "");
  change("\"normal\"", "\"gamma-process\"");
  change("mean = \"wear\"\nsd", "mean = \"b * time\"\nscale");
  change("limit = { wear", "limit = { depth");
  const Watched watched(study, lines(rates, 5, 0.1),
                        points({{1 * um / h, 0.3, 0.05 * um}, {1.1 * um / h, 0.4, 0.1 * um}}));
  FollowedUnit unit(*watched.tracker, "new");
  EXPECT_TRUE(unit.update({1 * um, 1 * h}).counted);
  EXPECT_TRUE(unit.update({3 * um, 3 * h}).counted);
  const std::string before = unit.unit->save();
  for (const auto& [depth, time] : {std::pair{2.5, 4.0}, {3.5, 2.0}, {2.0, 3.0}}) {
    const UpdateResult taken = unit.update({depth * um, time * h});
    EXPECT_FALSE(taken.counted);
    EXPECT_FALSE(taken.problem.empty());
    EXPECT_EQ(unit.unit->save(), before);
  }
  EXPECT_TRUE(unit.update({2 * um, 2 * h}).counted);
  EXPECT_EQ(unit.unit->readings(), 3u);
}

TEST(FormulaTracker, StudiesThatCannotBeFollowed) {
  std::string study = straight;
  const std::string limit = "limit = { wear = \"12 um\" }\n";
  study.erase(study.find(limit), limit.size());
  try {
    const Watched watched(study, lines(rates, 5, 0.3), points({{1 * um / h, 0.3, 0.3 * um}}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("has no limit"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace wearwell::formula_model
