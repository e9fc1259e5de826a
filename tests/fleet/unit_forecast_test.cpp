#include "wearwell/models/clutch/unit_forecast.h"

#include <gtest/gtest.h>

#include "fleet/sample_fleet.h"
#include "wearwell/models/clutch/cycle_sum.h"
#include "wearwell/models/clutch/fleet_counts.h"

namespace wearwell::clutch {
namespace {

const OperatingPoint at{250, 40, 180, 2};

/// The sums of a unit that has run `count` equal cycles, by CycleSum.
UnitSums after(const WearModel& model, int count) {
  CycleColumns columns;
  columns.plate.assign(static_cast<std::size_t>(count), 1);
  for (int i = 1; i <= count; ++i) columns.number.push_back(i);
  columns.slip_speed = Eigen::ArrayXd::Constant(count, at.slip_speed);
  columns.torque = Eigen::ArrayXd::Constant(count, at.torque);
  columns.temperature = Eigen::ArrayXd::Constant(count, at.temperature);
  columns.closing_time = Eigen::ArrayXd::Constant(count, at.closing_time);
  columns.energy = Eigen::ArrayXd::Constant(count, closing_energy(at));
  CycleSum sum(model, true);
  CycleSum::Rates rates;
  sum.rates(columns, rates);
  sum.add(columns, rates);
  const PlateWear& plate = sum.plates().front();
  UnitSums sums;
  sums.unit = "1";
  sums.cycles = count;
  sums.energy = plate.energy;
  sums.volume = plate.volume;
  sums.variance = plate.variance;
  sums.settled = count * rates.w[0] * closing_energy(at);
  sums.volumes = plate.replicates;
  sums.settleds = count * rates.replicates.row(0).transpose() * closing_energy(at);
  return sums;
}

WearModel long_lived() {
  WearModel model = fleet_model(ScatterKind::linear);
  model.worn_out = 1e-5;
  return model;
}

// A unit that goes on as it has run is worn out when a new one under that duty is, with both intervals.
TEST(UnitForecast, AgreesWithTheLifeOfANewPlate) {
  const WearModel model = long_lived();
  const Life life = predict_life(model, {{1, 1, at, closing_energy(at)}}, {0.5, 1});
  for (const int run : {1, 50, 3000}) {
    const UnitForecast forecast(model, after(model, run));
    for (const LifeAtLevel& level : life.levels) {
      const double target = level.level * model.worn_out;
      ASSERT_GT(level.full.low, run);
      EXPECT_NEAR((forecast.until(target) + run) / level.repetitions, 1, 1e-9);
      const LifeInterval scatter = forecast.scatter_interval(target);
      const LifeInterval full = forecast.full_interval(target);
      EXPECT_NEAR((scatter.low + run) / level.scatter.low, 1, 1e-8);
      EXPECT_NEAR((scatter.high + run) / level.scatter.high, 1, 1e-8);
      EXPECT_NEAR((full.low + run) / level.full.low, 1, 1e-8);
      if (std::isfinite(level.full.high)) {
        EXPECT_NEAR((full.high + run) / level.full.high, 1, 1e-8);
      } else {
        EXPECT_EQ(full.high, level.full.high);
      }
    }
  }
}

TEST(UnitForecast, OfAUnitBeyondTheLevelNothingIsLeft) {
  const WearModel model = long_lived();
  const UnitSums sums = after(model, 200);
  const UnitForecast forecast(model, sums);
  EXPECT_EQ(forecast.until(0.5 * sums.volume), 0);
  EXPECT_EQ(forecast.scatter_interval(0.1 * sums.volume).low, 0);
  EXPECT_EQ(forecast.scatter_interval(0.1 * sums.volume).high, 0);
  EXPECT_NEAR(forecast.reached(0, sums.volume, 0), 0.5, 1e-12);
}

TEST(UnitForecast, WhatDoesNotWearLastsForEver) {
  const WearModel model = long_lived();
  UnitSums sums = after(model, 10);
  sums.settled = 0;
  const UnitForecast forecast(model, sums);
  EXPECT_TRUE(std::isinf(forecast.until(model.worn_out)));
  EXPECT_TRUE(std::isinf(forecast.full_interval(model.worn_out).high));
}

// Equal units: if a replicate is true each is beyond the level with the same probability.
TEST(FleetCounts, AreThoseOfTheMixtureOverReplicates) {
  WearModel model = long_lived();
  const UnitSums sums = after(model, 3000);
  const UnitForecast forecast(model, sums);
  model.worn_out = 1.02 * sums.volume;
  FleetCounts counts(model, true, {1}, {0});
  constexpr int units = 400;
  for (int i = 0; i < units; ++i) counts.add(sums);
  const UnitCount n = counts.reached(0, 0);
  EXPECT_NEAR(n.expected, units * forecast.reached(0, model.worn_out, 0), 1e-6);
  double least = units, most = 0;
  for (std::size_t b = 1; b <= model.replicates.size(); ++b) {
    const double p = forecast.reached(b, model.worn_out, 0);
    least = std::min(least, units * p);
    most = std::max(most, units * p);
  }
  const double scatter = 3 * std::sqrt(units * 0.25);
  EXPECT_GE(n.low, std::max(0.0, least - scatter));
  EXPECT_LE(n.high, std::min<double>(units, most + scatter));
  EXPECT_LT(n.low, n.high);
}

// Where every model says that all units are beyond the level, or none, the interval is that number.
TEST(FleetCounts, WithoutDoubtHaveNoInterval) {
  WearModel model = long_lived();
  const UnitSums sums = after(model, 3000);
  for (const double share : {1e-3, 1e3}) {
    model.worn_out = share * sums.volume;
    FleetCounts counts(model, true, {1}, {0});
    for (int i = 0; i < 15; ++i) counts.add(sums);
    const UnitCount n = counts.reached(0, 0);
    EXPECT_NEAR(n.expected, share < 1 ? 15 : 0, 1e-9);
    EXPECT_LE(n.low, n.expected);
    EXPECT_GE(n.high, n.expected);
    EXPECT_NEAR(n.low, n.expected, 1e-6);
    EXPECT_NEAR(n.high, n.expected, 1e-6);
  }
}

// The model counts more units than any of its replicates.
TEST(FleetCounts, OfTheModelLieWithinTheirInterval) {
  WearModel model = long_lived();
  UnitSums sums = after(model, 3000);
  for (double& each : sums.volumes) each = 0.5 * sums.volume;
  sums.variance = 0;
  model.plate_sd = 0;
  model.worn_out = 0.9 * sums.volume;
  FleetCounts counts(model, true, {1}, {0});
  for (int i = 0; i < 15; ++i) counts.add(sums);
  const UnitCount n = counts.reached(0, 0);
  EXPECT_EQ(n.expected, 15);
  EXPECT_LT(n.low, 1e-6);
  EXPECT_EQ(n.high, 15);
}

// 1/2 x torque x slip speed x closing time of 250 rad/s, 40 N m, 2 s is 10 kJ.
TEST(FleetCounts, EnergyIsHeldAgainstTorqueSlipAndTime) {
  const WearModel model = long_lived();
  UnitSums sums = after(model, 3000);
  for (std::size_t i = 0; i < 4; ++i) sums.inputs[i] = 3000 * (at.*inputs[i].value);
  const auto implausible = [&](double factor) {
    FleetCounts counts(model, true, {1}, {0});
    UnitSums changed = sums;
    changed.energy *= factor;
    counts.add(sums);
    changed.unit = "changed";
    counts.add(changed);
    return counts.implausible();
  };
  EXPECT_EQ(implausible(1).units, 0u);
  EXPECT_EQ(implausible(2.5).units, 0u);
  EXPECT_EQ(implausible(0.4).units, 0u);
  for (const double factor : {1000.0, 1e-3}) {
    const FleetCounts::Implausible found = implausible(factor);
    EXPECT_EQ(found.units, 1u);
    EXPECT_EQ(found.worst, "changed");
    EXPECT_NEAR(found.ratio / factor, 1, 1e-12);
    EXPECT_NEAR(found.volume / sums.volume, 1, 1e-12);
  }
}

}  // namespace
}  // namespace wearwell::clutch
