// Units on line whose rate may change, against sums over dense grids of the rate, the place and the factor of the change, and
// against trackers without it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "models/formula_model/watched.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/formula_model/node_points.h"
#include "wearwell/models/formula_model/unit_nodes.h"

namespace wearwell::formula_model {
namespace {

using prognosis::Forecast;
using prognosis::Reading;

std::string with_change(const std::string& study, const std::string& every = "20 h",
                        const std::string& factor = "1 x/ 2") {
  return study + "rate_change = { every = \"" + every + "\", factor = \"" + factor + "\" }\n";
}

std::vector<Column> some_rows() {
  std::vector<double> depth, time;
  std::vector<std::string> unit;
  for (int u = 0; u < 3; ++u) {
    for (int i = 1; i <= 4; ++i) {
      time.push_back(i);
      depth.push_back((0.8 + 0.2 * u) * i);
      unit.push_back("u" + std::to_string(u));
    }
  }
  return {numbers("depth", depth), numbers("time", time), texts("unit", unit)};
}

// A known population; a few hundred points, so that the lines of nodes are dense together.
const std::vector<double> known = {1 * um / h, 0.3, 0.3 * um};

WeightedDraws known_population(const std::vector<double>& x) {
  std::vector<std::vector<double>> all;
  for (int i = 0; i < 256; ++i) {
    all.push_back(x);
    for (std::size_t p = 0; p < x.size(); ++p)
      all.back()[p] *= 1 + 1e-5 * std::sin(1.7 * i * (static_cast<double>(p) + 1));
  }
  return points(all);
}

// One unit y = b t, all over grids: the change, and the life until 12 um from the last reading on.
struct ByGrids {
  static constexpr double hazard = 1.0 / 20, limit = 12;
  double changed = 0, passed = 0;
  std::vector<std::pair<double, double>> lives, since, factor;

  explicit ByGrids(const std::vector<std::pair<double, double>>& readings) {
    const double now = readings.back().second;
    const auto density = [&](double z, double c, double f) {
      const double b = std::exp(0.3 * z);
      double log_f = -0.5 * z * z;
      for (const auto& [y, t] : readings) {
        const double off = (y - b * (t <= c ? t : c + f * (t - c))) / 0.3;
        log_f -= 0.5 * off * off;
      }
      return log_f;
    };
    constexpr double dz = 0.08, dv = 0.1, least = 1e-12;
    constexpr int places = 120;
    double all = 0;
    for (double z = -4.5; z <= 4.5; z += dz) {
      const double b = std::exp(0.3 * z);
      const double stays = std::exp(density(z, now, 1) - hazard * now) * dz;
      all += stays;
      if (stays > least) {
        // Changes to come, at even quantiles of both.
        constexpr int times = 50, factors = 50;
        for (int i = 0; i < times; ++i) {
          for (int j = 0; j < factors; ++j) {
            const double until = -std::log1p(-(i + 0.5) / times) / hazard;
            const double f = std::pow(2, normal_quantile((j + 0.5) / factors));
            const double left = limit / b - now;
            add(left <= until ? left : until + (left - until) / f, stays / times / factors);
          }
        }
      }
      for (double v = -4.5; v <= 4.5; v += dv) {
        const double f = std::pow(2, v);
        for (int k = 0; k < places; ++k) {
          const double c = now * (k + 0.5) / places;
          const double weight = std::exp(density(z, c, f) - 0.5 * v * v - hazard * c) /
                                std::sqrt(2 * M_PI) * hazard * now / places * dv * dz;
          if (!(weight > least)) continue;
          all += weight;
          changed += weight;
          since.emplace_back(c, weight);
          factor.emplace_back(f, weight);
          add((limit / b - c - f * (now - c)) / f, weight);
        }
      }
    }
    changed /= all;
    passed /= all;
  }
  void add(double life, double weight) {
    life > 0 ? static_cast<void>(lives.emplace_back(life, weight))
             : static_cast<void>(passed += weight);
  }
  static double quantile(std::vector<std::pair<double, double>> of, double p) {
    std::sort(of.begin(), of.end());
    double all = 0, below = 0;
    for (const auto& each : of) all += each.second;
    for (const auto& [x, weight] : of)
      if ((below += weight) >= p * all) return x;
    return of.back().first;
  }
};

const std::vector<std::pair<double, double>> of_a_change = {
    {0.9, 1}, {2.2, 2}, {2.8, 3}, {4.1, 4}, {5.4, 4.7}, {7.3, 5.5}, {8.6, 6.1}};

TEST(RateChange, AgreesWithGrids) {
  const Watched watched(with_change(straight), some_rows(), known_population(known));
  FollowedUnit unit(*watched.tracker, "new");
  std::vector<std::pair<double, double>> shown;
  for (const auto& [y, t] : of_a_change) {
    ASSERT_TRUE(unit.update({y * um, t * h}).counted);
    shown.emplace_back(y, t);
    if (shown.size() % 2 == 0) continue;
    const ByGrids grids(shown);
    const Forecast forecast = unit.unit->forecast();
    ASSERT_TRUE(forecast.rate_change);
    EXPECT_NEAR(forecast.rate_change->probability, grids.changed, 0.03) << t;
    EXPECT_NEAR(forecast.passed, grids.passed, 0.01) << t;
    for (const double p : {0.05, 0.25, 0.5, 0.75, 0.95}) {
      const double life = ByGrids::quantile(grids.lives, p);
      EXPECT_NEAR(forecast.remaining.cdf(life * h), p, 0.03) << t << " h, " << life << " h";
    }
    if (grids.changed < 0.5) continue;
    EXPECT_NEAR(forecast.rate_change->factor50, ByGrids::quantile(grids.factor, 0.5), 0.1) << t;
    EXPECT_NEAR(forecast.rate_change->since50 / h, ByGrids::quantile(grids.since, 0.5), 0.15) << t;
  }
  EXPECT_GT(unit.unit->forecast().rate_change->probability, 0.8);
}

// No rate changes between readings at the same use, but each says more on the earlier changes.
TEST(RateChange, TakesReadingsAtTheSameUse) {
  const Watched watched(with_change(straight), some_rows(), known_population(known));
  FollowedUnit unit(*watched.tracker, "new");
  std::vector<std::pair<double, double>> shown = of_a_change;
  for (const double y : {8.1, 8.3, 7.9, 8.2, 8.0}) shown.emplace_back(y, shown.back().second);
  for (const auto& [y, t] : shown) ASSERT_TRUE(unit.update({y * um, t * h}).counted);
  const ByGrids grids(shown);
  const Forecast forecast = unit.unit->forecast();
  EXPECT_NEAR(forecast.rate_change->probability, grids.changed, 0.04);
  for (const double p : {0.05, 0.25, 0.5, 0.75, 0.95})
    EXPECT_NEAR(forecast.remaining.cdf(ByGrids::quantile(grids.lives, p) * h), p, 0.05) << p;
}

// A population that five machines leave uncertain: the rate, its scatter, the noise of readings.
std::vector<std::vector<double>> uncertain_population() {
  Rng rng(7, 0);
  std::vector<std::vector<double>> all;
  for (int i = 0; i < 256; ++i)
    all.push_back({0.6 * std::exp(0.15 * rng.normal()), 0.35 * std::exp(0.3 * rng.normal()),
                   0.3 * std::exp(0.15 * rng.normal())});
  return all;
}

// The share of the remaining lives of a unit y = b t within `until`, of those that are left, and the effective number of draws: importance sampling
// of the population, the rate, the place and the factor of its change.
std::pair<double, double> share_within(const std::vector<std::vector<double>>& population,
                                       const std::vector<std::pair<double, double>>& readings,
                                       double until) {
  constexpr int draws = 300'000;
  const double now = readings.back().second, middle = readings[9].first / readings[9].second;
  Rng rng(9, 0);
  std::vector<double> log_weight, left;
  for (int i = 0; i < draws; ++i) {
    const auto& x = population[static_cast<std::size_t>(rng.uniform() * 256)];
    const double u = rng.normal(), v = rng.normal(), c = (0.3 + 0.7 * rng.uniform()) * now;
    const double log_b = std::log(middle) + 0.12 * u, log_f = std::log(3) + 0.35 * v;
    const double b = std::exp(log_b), f = std::exp(log_f);
    const double z = (log_b - std::log(x[0])) / x[1], g = log_f / std::log(2);
    double log_w = 0.5 * (u * u + v * v - z * z - g * g) - std::log(x[1]) - ByGrids::hazard * c;
    for (const auto& [y, t] : readings) {
      const double off = (y - b * (t <= c ? t : c + f * (t - c))) / x[2];
      log_w -= 0.5 * off * off + std::log(x[2]);
    }
    log_weight.push_back(log_w);
    left.push_back((ByGrids::limit / b - c - f * (now - c)) / f);
  }
  std::vector<double> weight;
  normalize(log_weight, weight);
  double within = 0, all = 0, squares = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    within += left[i] > 0 && left[i] <= until ? weight[i] : 0;
    all += left[i] > 0 ? weight[i] : 0;
    squares += weight[i] * weight[i];
  }
  return {within / all, 1 / squares};
}

// A change to three times the rate is rare under its prior: few of the particles that begin with it explain the next reading.
TEST(RateChange, AgreesWithImportanceSamplingForManyUnits) {
  const std::vector<std::vector<double>> population = uncertain_population();
  std::vector<std::vector<double>> in_si = population;
  for (auto& x : in_si) x = {x[0] * um / h, x[1], x[2] * um};
  const Watched watched(with_change(straight), some_rows(), points(in_si));
  Rng rng(3, 0);
  double sum = 0;
  int count = 0;
  for (int u = 0; u < 12; ++u) {
    FollowedUnit unit(*watched.tracker, "new " + std::to_string(u));
    const double b = 0.6 * std::exp(0.2 * rng.normal());
    std::vector<std::pair<double, double>> readings;
    for (int i = 1; i <= 15; ++i) {
      const double t = 0.5 * i;
      readings.emplace_back(b * (t <= 5 ? t : 5 + 3 * (t - 5)) + 0.3 * rng.normal(), t);
      ASSERT_TRUE(unit.update({readings.back().first * um, t * h}).counted);
    }
    const Forecast forecast = unit.unit->forecast();
    if (forecast.passed > 0.5) continue;  // few lives are left to compare
    for (const double p : {0.05, 0.5, 0.95}) {
      const auto [exact, effective] =
          share_within(population, readings, forecast.remaining.quantile(p) / h);
      ASSERT_GT(effective, 300) << u;
      EXPECT_NEAR(exact, p, 0.06) << u;
      sum += std::abs(exact - p);
      ++count;
    }
  }
  EXPECT_LT(sum / count, 0.02);
}

TEST(RateChange, ThatIsAsGoodAsImpossibleLeavesTheForecast) {
  const WeightedDraws population = known_population(known);
  const Watched plain(straight, some_rows(), population);
  const Watched rare(with_change(straight, "1e15 h"), some_rows(), population);
  for (const char* name : {"new", "u1"}) {
    FollowedUnit a(*plain.tracker, name), b(*rare.tracker, name);
    for (int i = 5; i < 11; ++i) {
      const Reading reading{{(1.02 * i + 0.2 * std::sin(i)) * um, i * h}, {}};
      const auto of_a = a.update(reading), of_b = b.update(reading);
      EXPECT_NEAR(of_a.p_value, of_b.p_value, 1e-9);
    }
    const Forecast without = a.unit->forecast(), with = b.unit->forecast();
    EXPECT_FALSE(without.rate_change);
    EXPECT_LT(with.rate_change->probability, 1e-6);
    EXPECT_NEAR(with.level50 / without.level50, 1, 1e-6);
    EXPECT_NEAR(with.passed, without.passed, 1e-6);
    for (const double p : {0.05, 0.5, 0.95})
      EXPECT_NEAR(with.remaining.quantile(p) / without.remaining.quantile(p), 1, 1e-4) << p;
  }
}

TEST(RateChange, ContinuesFromASavedStateWithTheSameBits) {
  const Watched watched(with_change(straight), some_rows(), known_population(known));
  FollowedUnit unit(*watched.tracker, "u0"), other(*watched.tracker, "u0");
  for (const auto& [y, t] : of_a_change) {
    const Reading reading{{(0.8 * 4 + y) * um, (t + 4) * h}, {}};
    unit.update(reading);
    other.update(reading);
    const std::string bytes = other.unit->save();
    other.unit = watched.tracker->restore(bytes);
    EXPECT_EQ(other.unit->save(), bytes);
    EXPECT_EQ(unit.unit->save(), bytes);
  }
  EXPECT_EQ(unit.unit->forecast().remaining.quantile(0.5),
            other.unit->forecast().remaining.quantile(0.5));
  std::string broken = unit.unit->save();
  broken[broken.size() / 2] ^= 1;
  EXPECT_THROW(watched.tracker->restore(broken), InputError);
}

TEST(RateChange, TakesLateReadings) {
  const Watched watched(with_change(straight), some_rows(), known_population(known));
  FollowedUnit in_order(*watched.tracker, "new"), late(*watched.tracker, "new");
  for (const auto& [y, t] : of_a_change) in_order.update({y * um, t * h});
  for (std::size_t i : {0u, 1u, 2u, 4u, 3u, 6u, 5u})
    late.update({of_a_change[i].first * um, of_a_change[i].second * h});
  const Forecast a = in_order.unit->forecast(), b = late.unit->forecast();
  EXPECT_NEAR(a.rate_change->probability, b.rate_change->probability, 0.05);
  for (const double p : {0.05, 0.5, 0.95})
    EXPECT_NEAR(b.remaining.cdf(a.remaining.quantile(p)), p, 0.07);
}

// The median of the path reaches the threshold at the median life: paths only rise.
TEST(RateChange, ForecastsThePathAhead) {
  const Watched watched(with_change(straight), some_rows(), known_population(known));
  FollowedUnit unit(*watched.tracker, "new");
  for (std::size_t i = 0; i < 6; ++i)
    unit.update({of_a_change[i].first * um, of_a_change[i].second * h});
  const Forecast now = unit.unit->forecast();
  const double places[] = {now.now, now.now + now.remaining.quantile(0.5)};
  const auto band = unit.unit->ahead(places);
  EXPECT_NEAR(band[0].level50 / now.level50, 1, 0.01);
  EXPECT_NEAR(band[1].level50 / um, 12, 0.35);
}

TEST(RateChange, OfAProcessWithoutNoise) {
  std::string study = straight;
  const std::string family = "family = \"normal\"\nmean = \"wear\"\nsd = \"sigma\"";
  study.replace(study.find(family), family.size(),
                "family = \"gamma-process\"\nmean = \"wear\"\nscale = \"sigma\"");
  study.replace(study.find("limit = { wear"), 14, "limit = { depth");
  std::vector<Column> rows = some_rows();
  const Watched watched(with_change(study, "50 h"), rows,
                        known_population({1 * um / h, 0.2, 0.03 * um}));
  FollowedUnit unit(*watched.tracker, "new"), late(*watched.tracker, "new");
  Rng rng(3, 0);
  double y = 0;
  std::vector<Reading> readings;
  for (int i = 1; i <= 9; ++i) {
    y += (i > 5 ? 0.3 : 1.0) * std::exp(0.15 * rng.normal());
    readings.push_back({{y * um, i * h}, {}});
    EXPECT_TRUE(unit.update(readings.back()).counted);
  }
  const prognosis::RateChange change = *unit.unit->forecast().rate_change;
  EXPECT_GT(change.probability, 0.95);
  EXPECT_LT(change.factor05, 0.3);
  EXPECT_GT(change.factor95, 0.3);
  EXPECT_LT(change.since05 / h, 5);
  EXPECT_GT(change.since95 / h, 5);
  // Increments between readings: a late one splits one, and all is computed in order.
  std::swap(readings[7], readings[8]);
  for (const Reading& each : readings) late.update(each);
  EXPECT_EQ(late.unit->forecast().rate_change->probability, change.probability);
}

TEST(RateChange, IsRefusedWhereItIsNotPossible) {
  const auto refusal = [](const std::string& study) {
    try {
      const Watched watched(study, some_rows(), known_population(known));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal(with_change(straight, "20 um")), testing::HasSubstr("every"));
  EXPECT_THAT(refusal(with_change(straight, "0 h")), testing::HasSubstr("must be positive"));
  EXPECT_THAT(refusal(with_change(straight, "20 h", "2")), testing::HasSubstr("needs its spread"));
  EXPECT_THAT(refusal(with_change(straight, "20 h", "1 x/ 0.5")),
              testing::HasSubstr("must be at least 1"));
  std::string running = straight;
  running.replace(running.find("b * time"), 8, "cum(b) * 1 [h]");
  EXPECT_THAT(refusal(with_change(running)), testing::HasSubstr("rate_change"));
}

}  // namespace
}  // namespace wearwell::formula_model
