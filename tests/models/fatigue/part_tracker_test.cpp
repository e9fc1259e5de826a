// Parts on line against sums over all nodes of the posterior, and against a posterior that has not seen the part.
// Longer than others: one part under one stress, under several, by population and from saved states share the studies above.
#include "wearwell/models/fatigue/part_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "models/tracked_preset.h"
#include "support/followed_unit.h"
#include "wearwell/base/error.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/life.h"
#include "wearwell/models/fatigue/sn_study.h"
#include "wearwell/models/fatigue/stress_lives.h"
#include "wearwell/prognosis/tracked_life.h"

namespace wearwell::fatigue {
namespace {

using prognosis::Forecast;
using testing::HasSubstr;

const std::vector<std::string> headings = {"S", "N", "status", "name"};
using PartRows = std::vector<std::vector<std::string>>;

const PartRows part_rows = {{"500", "45000", "failure", "a"},  {"500", "98000", "failure", "b"},
                            {"430", "240000", "failure", "c"}, {"430", "330000", "failure", "d"},
                            {"380", "610000", "failure", "e"}, {"380", "1300000", "failure", "f"},
                            {"350", "900000", "failure", "g"}, {"350", "2000000", "runout", "h"},
                            {"320", "2000000", "runout", "i"}, {"320", "1700000", "failure", "j"}};

std::string part_study(const std::string& law, const std::string& likelihood,
                       const std::string& prior, const std::string& predict = "") {
  return R"toml(model = "sn"
[data]
file = "data.csv"
[data.columns]
alternating_stress = { column = "S", unit = "MPa" }
life = "N"
status = "status"
part = "name"
[law]
mean_stress = "none"
)toml" + law +
         "\n[likelihood]\nfamily = \"" + likelihood + "\"\n[prior]\n" + prior + predict;
}

const std::string line =
    "log10_a = { distribution = \"normal\", mean = \"3.3 log10(MPa)\", sd = 0.3 }\n"
    "b = { distribution = \"normal\", mean = -0.1, sd = 0.04 }\n"
    "sigma = { distribution = \"half-normal\", scale = 0.3 }\n";
const std::string below_a_limit =
    "log10_a = { distribution = \"normal\", mean = \"3.6 log10(MPa)\", sd = 0.3 }\n"
    "b = { distribution = \"normal\", mean = -0.2, sd = 0.06 }\n"
    "sigma = { distribution = \"half-normal\", scale = 0.3 }\n"
    "log10_limit = { distribution = \"normal\", mean = \"2.48 log10(MPa)\", sd = 0.05 }\n";

struct Chosen {
  const char* law;
  const char* likelihood;
  const std::string* prior;
};

std::vector<Chosen> chosen() {
  return {{"", "log10-normal", &line}, {"", "weibull", &line}};
}

Stress under(double mpa) {
  return {mpa * 1e6, 0};
}

// P(N <= n + r | N > n) where the posterior has N > known already.
double ended(const SnLaw& law, const WeightedDraws& posterior, const Stress& stress, double known,
             double n, double r) {
  double all = 0, left = 0;
  for (Eigen::Index i = 0; i < posterior.values.rows(); ++i) {
    const double* x = posterior.values.row(i).data();
    const double before = known > 0 ? survival(law, x, stress, known) : 1;
    if (!(before > 0)) continue;
    const double weight = posterior.weights[i] / before;
    all += weight * (n > 0 ? survival(law, x, stress, n) : 1);
    left += weight * survival(law, x, stress, n + r);
  }
  return 1 - left / all;
}

void expect_same(const Forecast& forecast, const std::function<double(double)>& truth,
                 double tolerance) {
  for (const double p : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99}) {
    const double r = forecast.remaining.quantile(p);
    if (!std::isfinite(r)) continue;
    EXPECT_NEAR(truth(r), p, tolerance) << p;
  }
}

SnLaw law_of(const TrackedPreset& preset) {
  return read_sn_law(TomlReader::parse(preset.state.source.study));
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(PartTracker, IsTheSumOverAllNodes) {
  for (const Chosen& each : chosen()) {
    SCOPED_TRACE(each.likelihood);
    const TrackedPreset preset(part_study(each.law, each.likelihood, *each.prior), headings,
                               part_rows);
    ASSERT_TRUE(preset.tracker);
    EXPECT_THAT(std::vector(preset.tracker->seen().begin(), preset.tracker->seen().end()),
                testing::ElementsAre("h", "i"));
    const SnLaw law = law_of(preset);
    FollowedUnit seen(*preset.tracker, "h");
    EXPECT_EQ(seen.unit->forecast().now, 2e6);
    expect_same(
        seen.unit->forecast(),
        [&](double r) { return ended(law, preset.state.posterior, under(350), 2e6, 2e6, r); },
        2e-3);
    EXPECT_TRUE(seen.update({3.5e6, none}).counted);
    expect_same(
        seen.unit->forecast(),
        [&](double r) { return ended(law, preset.state.posterior, under(350), 2e6, 3.5e6, r); },
        2e-3);
    FollowedUnit fresh(*preset.tracker, "new");
    EXPECT_TRUE(std::isnan(fresh.unit->forecast().passed));  // its stress is not known
    EXPECT_THAT(fresh.update({1e5, none}).problem, HasSubstr("alternating_stress is missing"));
    const double chance = 1 - ended(law, preset.state.posterior, under(400), 0, 0, 4e5);
    EXPECT_NEAR(fresh.update({4e5, 400e6}).p_value, chance, 2e-3);
    expect_same(
        fresh.unit->forecast(),
        [&](double r) { return ended(law, preset.state.posterior, under(400), 0, 4e5, r); }, 2e-3);
  }
}

// The study's own run-out is in the posterior: with it taken out of the data and followed instead it comes to the same.
TEST(PartTracker, ARunoutCountsOnce) {
  const std::string study = part_study("", "log10-normal", line);
  const TrackedPreset whole(study, headings, part_rows);
  PartRows others = part_rows;
  others.erase(others.begin() + 7);
  const TrackedPreset without(study, headings, others);
  FollowedUnit known(*whole.tracker, "h"), fresh(*without.tracker, "h");
  EXPECT_TRUE(fresh.update({2e6, 350e6}).counted);
  for (const double n : {2e6, 3e6, 6e6}) {
    EXPECT_TRUE(known.update({n, none}).counted);
    EXPECT_TRUE(fresh.update({n, none}).counted);
    const Forecast a = known.unit->forecast(), b = fresh.unit->forecast();
    for (const double p : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99})
      EXPECT_NEAR(a.remaining.cdf(b.remaining.quantile(p)), p, 4e-3) << n;
  }
}

TEST(PartTracker, LifeWithoutEndIsTold) {
  PartRows rows = part_rows;
  rows.push_back({"250", "3000000", "runout", "k"});
  const TrackedPreset preset(part_study("curve = \"stromeyer\"", "log10-normal", below_a_limit),
                             headings, rows);
  const SnLaw law = law_of(preset);
  const auto truth = [&](double n, double r) {
    return ended(law, preset.state.posterior, under(250), 3e6, n, r);
  };
  const prognosis::UnitLife life =
      prognosis::tracked_life(*preset.tracker, "k", {.unit = "k", .survived = "4e6 cycles"});
  ASSERT_TRUE(life.never);
  const double never = 1 - truth(4e6, StressLives::most_cycles);
  EXPECT_GT(never, 0.01);
  EXPECT_NEAR(*life.never, never, 4e-3);
  ASSERT_TRUE(life.passed);
  EXPECT_NEAR(*life.passed, truth(3e6, 1e6), 2e-3);
  for (const double p : {0.01, 0.1, 0.3}) {
    if (p > 0.9 * (1 - never)) continue;
    EXPECT_NEAR(truth(4e6, life.quantile(p)), p, 4e-3);
  }
  EXPECT_EQ(life.quantile(std::min(0.9999, 1 - 0.5 * never)), infinity);
}

// A posterior made by hand.
WeightedDraws scattered(const std::vector<double>& middle, const std::vector<double>& width) {
  constexpr Eigen::Index count = 200;
  WeightedDraws draws;
  draws.values.resize(count, static_cast<Eigen::Index>(middle.size()));
  draws.weights.setConstant(count, 1.0 / count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < middle.size(); ++j) {
      const double place = std::fmod(0.5 + 0.7548776662 / std::pow(1.3, double(j)) * double(i), 1);
      draws.values(i, static_cast<Eigen::Index>(j)) = middle[j] + width[j] * (place - 0.5);
    }
  }
  return draws;
}

void expect_sums(const SnLaw& law, const WeightedDraws& draws) {
  const ThinnedPosterior few(draws, 1000);
  for (const double mpa : {260.0, 300.0, 400.0}) {
    const StressLives lives(law, few, under(mpa));
    for (const double n : {0.0, 1e5, 1e7}) {
      if (1 - ended(law, draws, under(mpa), 0, 0, std::max(n, 1.0)) < 1e-6) continue;
      std::vector<double> weight = lives.log_survival(n, 0);
      for (std::size_t i = 0; i < weight.size(); ++i)
        weight[i] = few.weights[i] * std::exp(weight[i]);
      const prognosis::WeightedLives remaining = lives.remaining(weight, n);
      for (const double r : {2e4, 3e5, 5e6, 1e9})
        EXPECT_NEAR(remaining.cdf(r), ended(law, draws, under(mpa), 0, n, r), 4e-3)
            << mpa << " " << n << " " << r;
    }
  }
}

// Limits that scatter: slices against the integral, far out as well.
TEST(StressLives, OfARandomLimitAreItsIntegral) {
  SnLaw law;
  law.correction = MeanStress::none;
  for (const auto family : {LifeFamily::log10_normal, LifeFamily::weibull}) {
    law.family = family;
    law.limit = StandardDistribution::normal;
    expect_sums(law, scattered({9.6, -0.25, 0.2, 8.4, 0.03}, {0.04, 0.01, 0.05, 0.03, 0.01}));
  }
}

TEST(StressLives, BelowAKneeHaveNoEnd) {
  SnLaw law;
  law.correction = MeanStress::none;
  law.curve = SnCurve::knee;
  law.second_slope = SecondSlope::infinite;
  law.limit = StandardDistribution::normal;
  expect_sums(law, scattered({8, 5.8, 0.2, 8.45, 0.04}, {1, 0.1, 0.05, 0.03, 0.02}));
}

TEST(StressLives, OfCurvesThatBend) {
  SnLaw law;
  law.correction = MeanStress::none;
  law.curve = SnCurve::knee;
  expect_sums(law, scattered({8, 5.8, 8.45, 15, 0.2}, {1, 0.1, 0.03, 2, 0.05}));
  law.curve = SnCurve::bastenaire;
  expect_sums(law, scattered({5.9, 8.3, 0.8, 8.1, 0.2}, {0.1, 0.1, 0.1, 0.03, 0.05}));
  law.curve = SnCurve::basquin;
  law.family = LifeFamily::normal;
  expect_sums(law, scattered({9.35, -0.15, 1e5}, {0.05, 0.01, 5e4}));
}

TEST(PartTracker, OrderAndStatesChangeNoBit) {
  const TrackedPreset preset(part_study("", "weibull", line), headings, part_rows);
  FollowedUnit in_order(*preset.tracker, "x"), late(*preset.tracker, "x");
  for (const double n : {1e5, 2e5, 3e5}) in_order.update({n, 420e6});
  for (const double n : {3e5, 1e5, 2e5}) EXPECT_TRUE(late.update({n, 420e6}).counted);
  const auto restored = preset.tracker->restore(in_order.unit->save());
  for (const auto* other : {late.unit.get(), restored.get()}) {
    EXPECT_EQ(other->save(), in_order.unit->save());
    EXPECT_EQ(other->forecast().remaining.quantile(0.5),
              in_order.unit->forecast().remaining.quantile(0.5));
  }
  std::string damaged = in_order.unit->save();
  damaged.back() ^= 1;
  EXPECT_THROW(preset.tracker->restore(damaged), InputError);
}

// Sums over all nodes: the part keeps its score at both stresses (one slope at each node).
TEST(PartTracker, UnderAChangingStressIsMinersSum) {
  for (const Chosen& each : chosen()) {
    SCOPED_TRACE(each.likelihood);
    const TrackedPreset preset(part_study(each.law, each.likelihood, *each.prior), headings,
                               part_rows);
    const SnLaw law = law_of(preset);
    const auto left = [&](const std::vector<std::pair<double, double>>& run, double known) {
      double sum = 0;
      const WeightedDraws& all = preset.state.posterior;
      for (Eigen::Index i = 0; i < all.values.rows(); ++i) {
        const double* x = all.values.row(i).data();
        double damage = 0;
        for (const auto& [mpa, n] : run)
          damage += n / std::pow(10, law.log10_life(x, std::log10(mpa * 1e6)));
        const double before = known > 0 ? survival(law, x, under(350), known) : 1;
        if (!(before > 0)) continue;
        const double z = std::log10(damage) / x[law.sigma_index()];
        sum += all.weights[i] / before * std::exp(log_survival_and_slope(law.standard(), z).value);
      }
      return sum;
    };
    FollowedUnit fresh(*preset.tracker, "new");
    double survived = fresh.update({2e5, 400e6}).p_value;
    survived *= fresh.update({1e6, 330e6}).p_value;
    const double all = left({{400, 2e5}, {330, 8e5}}, 0);
    EXPECT_NEAR(survived, all, 4e-3);
    expect_same(
        fresh.unit->forecast(),
        [&](double r) {
          return 1 - left({{400, 2e5}, {330, 8e5 + r}}, 0) / all;
        },
        4e-3);
    // A run-out of the study goes on under another stress: its cycles there count once.
    FollowedUnit seen(*preset.tracker, "h");
    EXPECT_TRUE(seen.update({2.4e6, 420e6}).counted);
    const double now = left({{350, 2e6}, {420, 4e5}}, 2e6);
    const Forecast forecast = seen.unit->forecast();
    expect_same(
        forecast,
        [&](double r) {
          return 1 - left({{350, 2e6}, {420, 4e5 + r}}, 2e6) / now;
        },
        4e-3);
    EXPECT_GT(forecast.level50, 0.2);
    EXPECT_LT(forecast.level95, 1);
    const auto path = seen.unit->ahead(prognosis::places_ahead(forecast));
    ASSERT_FALSE(path.empty());
    EXPECT_NEAR(path.front().level50, forecast.level50, 0.02);
    for (std::size_t i = 1; i < path.size(); ++i) EXPECT_GT(path[i].level50, path[i - 1].level50);
    const auto apart = seen.unit->in_populations([](const auto&) {});
    ASSERT_TRUE(apart);
    const std::vector<double> before = preset.tracker->populations();
    const double r = forecast.remaining.quantile(0.5);
    double sum = 0, mass = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double weight = before[i] * std::exp(apart->log_likelihood[i]);
      mass += weight;
      sum += weight * apart->remaining[i].cdf(r);
    }
    EXPECT_NEAR(sum / mass, 0.5, 2e-3);
  }
}

TEST(PartTracker, ReadingsUnderChangingStressesMayComeInAnyOrder) {
  const TrackedPreset preset(part_study("", "weibull", line), headings, part_rows);
  const std::vector<std::vector<double>> readings = {
      {1e5, 420e6}, {1.5e5, 350e6}, {1.8e5, none}, {3e5, 400e6}, {3.2e5, 420e6}};
  FollowedUnit in_order(*preset.tracker, "x"), late(*preset.tracker, "x");
  for (const auto& each : readings) EXPECT_TRUE(in_order.update(each).counted);
  for (const std::size_t i : {3u, 0u, 4u, 1u, 2u}) EXPECT_TRUE(late.update(readings[i]).counted);
  const auto restored = preset.tracker->restore(in_order.unit->save());
  for (const auto* other : {late.unit.get(), restored.get()}) {
    EXPECT_EQ(other->save(), in_order.unit->save());
    EXPECT_EQ(other->forecast().remaining.quantile(0.5),
              in_order.unit->forecast().remaining.quantile(0.5));
  }
  EXPECT_THAT(late.update({1.5e5, 360e6}).problem, HasSubstr("under 350 MPa, and under 360 MPa"));
  // The reading is predicted before it is taken.
  const auto tails = in_order.unit->predictive({{3.4e5, 330e6}, {}});
  ASSERT_EQ(tails.size(), 1u);
  EXPECT_EQ(in_order.update({3.4e5, 330e6}).p_value, tails[0].above);
}

// Cycles that a reading without a stress has counted under one stress cannot have run under another.
TEST(PartTracker, ALateStressThatContradictsTheCyclesIsRefused) {
  const TrackedPreset preset(part_study("", "weibull", line), headings, part_rows);
  FollowedUnit part(*preset.tracker, "x");
  for (const auto& each : std::vector<std::vector<double>>{{1e5, 420e6}, {2e5, none}, {3e5, none}})
    EXPECT_TRUE(part.update(each).counted);
  const std::string before = part.unit->save();
  EXPECT_THAT(part.update({2e5, 350e6}).problem, HasSubstr("under 420 MPa, and under 350 MPa"));
  EXPECT_EQ(part.unit->save(), before);
  EXPECT_TRUE(part.update({2e5, 420e6}).counted);
}

// The same bits as from one reading: a constant stress is read from the study's lives.
TEST(PartTracker, OneStressIsThatOfTheStudy) {
  const TrackedPreset preset(part_study("", "log10-normal", line), headings, part_rows);
  FollowedUnit once(*preset.tracker, "x"), divided(*preset.tracker, "x");
  once.update({3e5, 420e6});
  for (const double n : {1.1e5, 2.7e5, 3e5}) divided.update({n, 420e6});
  for (const double p : {0.01, 0.1, 0.5, 0.9})
    EXPECT_EQ(once.unit->forecast().remaining.quantile(p),
              divided.unit->forecast().remaining.quantile(p));
}

// Under one stress normal lives are followed; damage has no sum there.
TEST(PartTracker, NormalLivesHaveNoSumOfDamage) {
  const std::string wide =
      "log10_a = { distribution = \"normal\", mean = \"3.3 log10(MPa)\", sd = 0.3 }\n"
      "b = { distribution = \"normal\", mean = -0.1, sd = 0.04 }\n"
      "sigma = { distribution = \"half-normal\", scale = \"3e5 cycles\" }\n";
  const TrackedPreset preset(part_study("", "normal", wide), headings, part_rows);
  FollowedUnit part(*preset.tracker, "x");
  EXPECT_TRUE(part.update({1e4, 400e6}).counted);
  EXPECT_TRUE(part.update({2e4, 400e6}).counted);
  EXPECT_THAT(part.update({3e4, 360e6}).problem,
              HasSubstr("the study's lives are normal in cycles (likelihood.family)"));
  EXPECT_EQ(part.unit->forecast().now, 2e4);
  EXPECT_THROW(TrackedPreset(part_study("", "normal", wide, "[predict]\ndamage_sum = \"1 x/ 2\"\n"),
                             headings, part_rows),
               InputError);
}

TEST(PartTracker, ADamageSumThatScattersWidensLives) {
  const auto study = [&](const std::string& sum) {
    return part_study("", "log10-normal", line, "[predict]\n" + sum);
  };
  const TrackedPreset known(study(""), headings, part_rows),
      one(study("damage_sum = \"1\"\n"), headings, part_rows),
      scatters(study("damage_sum = \"0.7 x/ 2\"\n"), headings, part_rows);
  std::vector<double> b10, median;
  for (const TrackedPreset* each : {&known, &one, &scatters}) {
    FollowedUnit part(*each->tracker, "x");
    part.update({1e4, 420e6});
    part.update({2e4, 380e6});
    b10.push_back(part.unit->forecast().remaining.quantile(0.1));
    median.push_back(part.unit->forecast().remaining.quantile(0.5));
  }
  EXPECT_EQ(b10[1], b10[0]);
  EXPECT_LT(b10[2], 0.7 * b10[0]);
  EXPECT_NEAR(median[2] / median[0], 0.7, 0.05);
  EXPECT_THROW(TrackedPreset(study("damage_sum = \"1 x/ 0.5\"\n"), headings, part_rows),
               InputError);
  EXPECT_THROW(TrackedPreset(study("damage_sum = \"0\"\n"), headings, part_rows), InputError);
}

// Population by population, mixed by likelihood, it is the forecast.
TEST(PartTracker, PopulationsTogetherAreTheForecast) {
  const TrackedPreset preset(part_study("", "log10-normal", line), headings, part_rows);
  FollowedUnit seen(*preset.tracker, "i");
  seen.update({5e6, none});
  const Forecast forecast = seen.unit->forecast();
  const auto apart = seen.unit->in_populations([](const auto&) {});
  ASSERT_TRUE(apart);
  const std::vector<double> before = preset.tracker->populations();
  for (const double p : {0.05, 0.5, 0.95}) {
    const double r = forecast.remaining.quantile(p);
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double weight = before[i] * std::exp(apart->log_likelihood[i]);
      all += weight;
      sum += weight * apart->remaining[i].cdf(r);
    }
    EXPECT_NEAR(sum / all, p, 2e-3);
  }
}

TEST(PartTracker, SaysWhatCannotBe) {
  const TrackedPreset preset(part_study("", "log10-normal", line), headings, part_rows);
  EXPECT_THAT(preset.tracker->refusal("c"), HasSubstr("row 3 of data.csv, where it failed"));
  FollowedUnit seen(*preset.tracker, "h");
  EXPECT_THAT(seen.update({1e6, 360e6}).problem,
              HasSubstr("until 2e+06 cycles it ran under 350 MPa in the study, not under 360 MPa"));
  EXPECT_TRUE(seen.update({2.1e6, 360e6}).counted);
  EXPECT_THAT(
      seen.update({2.1e6, 350e6}).problem,
      HasSubstr("at 2.1e+06 cycles it ran under 360 MPa, and under 350 MPa: a reading gives "
                "all cycles since the beginning"));
  EXPECT_THAT(seen.update({none, 350e6}).problem, HasSubstr("life is missing"));
  EXPECT_THAT(seen.update({-1, 350e6}).problem, HasSubstr("0 or more"));
  FollowedUnit fresh(*preset.tracker, "z");
  EXPECT_TRUE(fresh.update({3e6, 500e6}).contradicts);
  const auto life = [&](const std::string& survived) {
    return prognosis::tracked_life(*preset.tracker, "h", {.unit = "h", .survived = survived});
  };
  EXPECT_THROW(life("1e6 cycles"), InputError);
  EXPECT_THROW(prognosis::tracked_life(*preset.tracker, "c", {.unit = "c"}), InputError);
  PartRows twice = part_rows;
  twice[9][3] = "i";
  EXPECT_THROW(TrackedPreset(part_study("", "log10-normal", line), headings, twice), InputError);
}

// What a study asks for beside lives changes none of them.
TEST(PartTracker, SurvivalThatIsAskedForIsNoCondition) {
  const auto study = [&](const std::string& more) {
    return part_study(
        "", "log10-normal", line,
        "[predict]\n" + more + "[predict.stress]\nshaft = { alternating_stress = \"400 MPa\" }\n");
  };
  const TrackedPreset plain(study(""), headings, part_rows);
  const TrackedPreset asked(study("survival_to = \"5e5 cycles\"\n"), headings, part_rows);
  const prognosis::UnitLife a = plain.life({.unit = "shaft"}), b = asked.life({.unit = "shaft"});
  EXPECT_FALSE(a.passed);
  EXPECT_FALSE(b.passed);
  EXPECT_EQ(a.quantile(0.1), b.quantile(0.1));
  // The one stress that the study asks about is that of parts to come.
  const Forecast fresh = plain.tracker->begin("new")->forecast();
  expect_life(fresh, a, 1, 2e-3);
}

}  // namespace
}  // namespace wearwell::fatigue
