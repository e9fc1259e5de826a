#include "wearwell/models/recurrence/trend_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "histories.h"
#include "support/scratch.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/recurrence/mean_cumulative.h"

namespace wearwell::recurrence {
namespace {

// Published by MIL-HDBK-189 and IEC 61710: quantiles of the statistic, from simulations.
TEST(CramerVonMises, HasThePublishedCriticalValues) {
  struct Critical {
    std::size_t failures;
    double p, value;
  };
  for (const Critical& each : {Critical{3, 0.1, 0.154},
                               {3, 0.05, 0.184},
                               {3, 0.01, 0.231},
                               {10, 0.2, 0.125},
                               {10, 0.1, 0.167},
                               {10, 0.05, 0.212},
                               {20, 0.2, 0.128},
                               {20, 0.1, 0.172},
                               {20, 0.05, 0.217},
                               {20, 0.01, 0.33},
                               {60, 0.1, 0.173}}) {
    const double se = std::sqrt(each.p * (1 - each.p) / 10000);
    EXPECT_NEAR(crow_p_value(each.value, each.failures), each.p, 4 * se) << each.failures;
  }
}

// The same numbers by tests/golden/crow.R.
TEST(CramerVonMises, OfCrowsThreeSystems) {
  const TrendTest test = cramer_von_mises_test(three_systems().units);
  EXPECT_EQ(test.problem, "");
  EXPECT_EQ(test.failures, 36U);
  EXPECT_NEAR(test.statistic, 0.06953089, 1e-8);
  EXPECT_GT(test.p, 0.2);  // the power law is accepted at every published level
}

TEST(CramerVonMises, LeavesOutTheFailureThatEndsATest) {
  const std::vector<double> forty = {
      0.7,    3.7,    13.2,   17.6,   54.5,   99.2,   112.2,  120.9,  151.0,  163.0,
      174.5,  191.6,  282.8,  355.2,  486.3,  490.5,  513.3,  558.4,  678.1,  688.0,
      785.9,  887.0,  1010.7, 1029.1, 1034.4, 1136.1, 1178.9, 1259.7, 1297.9, 1419.7,
      1571.7, 1629.8, 1702.4, 1928.9, 2072.3, 2525.2, 2928.5, 3016.4, 3181.0, 3256.3};
  const TrendTest test = cramer_von_mises_test({{"1", 0, forty.back(), forty, true}});
  EXPECT_EQ(test.failures, 39U);
  EXPECT_NEAR(test.statistic, 0.06827868, 1e-8);
}

TEST(CramerVonMises, SaysWhereItDoesNotApply) {
  EXPECT_NE(cramer_von_mises_test({{"1", 10, 100, {20, 30, 40, 50}, false}}).problem, "");
  EXPECT_NE(cramer_von_mises_test({{"1", 0, 100, {20, 30}, false}}).problem, "");
}

// By hand: (10 + 30 - 2 x 50)/sqrt(2 x 100^2/12), and of a unit that begins at 100.
TEST(Laplace, ByHand) {
  const TrendTest early = laplace_test({{"1", 0, 100, {10, 30}, false}});
  EXPECT_NEAR(early.statistic, -60 / std::sqrt(2e4 / 12), 1e-12);
  EXPECT_NEAR(early.p, std::erfc(60 / std::sqrt(2e4 / 12) / std::sqrt(2.0)), 1e-12);
  EXPECT_NEAR(laplace_test({{"1", 100, 200, {110, 130}, false}}).statistic, early.statistic, 1e-12);
  EXPECT_NEAR(laplace_test({{"1", 0, 100, {10, 30, 100}, true}}).statistic, early.statistic, 1e-12);
  EXPECT_NE(laplace_test({{"1", 0, 100, {}, false}}).problem, "");
}

// Two equal units: the number of the first is binomial, so p of 0 and 6 failures is 2/64, of 3 and 3 it is 1.
TEST(Dispersion, OfTwoUnitsIsBinomial) {
  const auto p_of = [](std::size_t a, std::size_t b) {
    return dispersion_test({{"1", 0, 9, std::vector<double>(a, 1), false},
                            {"2", 0, 9, std::vector<double>(b, 1), false}},
                           {1, 1});
  };
  EXPECT_NEAR(p_of(0, 6).p, 2.0 / 64, 4 * std::sqrt(0.03 / 10000));
  EXPECT_NEAR(p_of(0, 6).statistic, 6, 1e-12);
  EXPECT_NEAR(p_of(1, 5).p, 14.0 / 64, 4 * std::sqrt(0.17 / 10000));
  EXPECT_EQ(p_of(3, 3).p, 1);
}

class MeanCumulative : public ScratchTest {};

// By survfit of R's package survival, whose jackknife over engines is the robust variance (tests/golden/valve_seats.R).
TEST_F(MeanCumulative, OfTheValveSeatsIsThatOfR) {
  const std::string folder = PROJECT_SOURCE_DIR "/examples/repairable/";
  const Source source = source_of(folder + "study.toml");
  const RecurrenceData data = read_recurrence_data(TomlReader::parse(source.study), source);
  ASSERT_EQ(data.units.size(), 41U);
  EXPECT_EQ(data.failures(), 48U);
  const std::vector<MeanCumulativeStep> steps = mean_cumulative(data.units, 0.95);
  std::ifstream golden(PROJECT_SOURCE_DIR "/tests/golden/valve_seats.csv");
  std::string line;
  std::getline(golden, line);
  std::size_t compared = 0;
  while (std::getline(golden, line)) {
    double age = 0, mean = 0, se = 0;
    char comma = 0;
    std::istringstream cells(line);
    if (!(cells >> age >> comma >> mean >> comma >> se)) continue;
    if (age != std::round(age)) continue;  // the first of two failures on one day
    ASSERT_LT(compared, steps.size());
    const MeanCumulativeStep& step = steps[compared++];
    EXPECT_NEAR(from_si(data.unit, step.age), age, 1e-9);
    EXPECT_NEAR(step.mean, mean, 1e-8);
    EXPECT_NEAR(step.se, se, 1e-8);
    EXPECT_NEAR(step.low * step.high, step.mean * step.mean, 1e-12);
    EXPECT_NEAR(std::log(step.high / step.mean), 1.959964 * step.se / step.mean, 1e-6);
  }
  EXPECT_EQ(compared, steps.size());
}

// Before a unit's observation begins it is not at risk.
TEST(MeanCumulativeFunction, CountsUnitsUnderObservation) {
  const auto steps = mean_cumulative(
      {{"1", 0, 10, {2, 8}, false}, {"2", 5, 12, {11}, false}, {"3", 0, 8, {}, false}}, 0.9);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0].at_risk, 2U);
  EXPECT_EQ(steps[1].at_risk, 3U);  // a unit counts at the age of its end
  EXPECT_EQ(steps[2].at_risk, 1U);
  EXPECT_NEAR(steps[2].mean, 1.0 / 2 + 1.0 / 3 + 1, 1e-12);
  // At age 2: units 1 and 3 differ from their mean by 1/2, over 2 at risk.
  EXPECT_NEAR(steps[0].se, std::sqrt(2.0) / 4, 1e-12);
  // One unit at risk shows no variance.
  EXPECT_TRUE(std::isnan(steps[2].se) && std::isnan(steps[2].low));
}

// The sum over units of squared deviations, each unit by itself.
TEST(MeanCumulativeFunction, VarianceIsTheSumOverUnits) {
  Rng rng(20261126, 3);
  std::vector<UnitHistory> units;
  for (int i = 0; i < 40; ++i) {
    UnitHistory unit{std::to_string(i), i % 3 == 0 ? rng.uniform(0, 4) : 0, 0};
    unit.end = unit.start + rng.uniform(3, 12);
    for (double age = unit.start; (age += -3 * std::log(rng.uniform())) < unit.end;)
      unit.failures.push_back(std::ceil(4 * age) / 4 < unit.end ? std::ceil(4 * age) / 4 : age);
    units.push_back(unit);
  }
  const std::vector<MeanCumulativeStep> steps = mean_cumulative(units, 0.9);
  std::vector<double> deviation(units.size());
  for (const MeanCumulativeStep& step : steps) {
    const auto at_risk = static_cast<double>(step.at_risk);
    double sum = 0;
    for (std::size_t i = 0; i < units.size(); ++i) {
      const UnitHistory& unit = units[i];
      const auto own = std::count(unit.failures.begin(), unit.failures.end(), step.age);
      if (unit.start < step.age && step.age <= unit.end)
        deviation[i] +=
            (static_cast<double>(own) - static_cast<double>(step.failures) / at_risk) / at_risk;
      sum += deviation[i] * deviation[i];
    }
    if (std::isnan(step.se)) continue;
    EXPECT_NEAR(step.se, std::sqrt(sum), 1e-12);
  }
  EXPECT_GT(steps.size(), 40U);
}

TEST(MeanCumulativeFunction, AgesWithoutAnyUnit) {
  const std::vector<UnitHistory> units = {
      {"1", 1, 4, {2}, false}, {"2", 3, 6, {}, false}, {"3", 9, 12, {11}, false}};
  using Ages = std::vector<std::pair<double, double>>;
  EXPECT_EQ(unobserved_ages(units), (Ages{{6, 9}}));
  EXPECT_EQ(unobserved_ages({{"1", 0, 4, {2}, false}, {"2", 4, 6, {}, false}}), Ages());
}

}  // namespace
}  // namespace wearwell::recurrence
