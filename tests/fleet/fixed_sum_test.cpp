// The loop of our own that sums a fleet's cycles, against sums in plain C++ and in more digits.
#include "wearwell/models/clutch/fixed_sum.h"

#include <gtest/gtest.h>

#include "fleet/sample_fleet.h"
#include "wearwell/base/error.h"
#include "wearwell/models/clutch/lanes.h"

namespace wearwell::clutch {
namespace {

TEST(Lanes, ExpAndLogAreThoseOfTheLibrary) {
  Rng rng(1, 0);
  for (int i = 0; i < 200'000; ++i) {
    const double x = rng.uniform(-699, 708);
    EXPECT_NEAR(lanes::exp(x) / std::exp(x), 1, 1.5e-14) << x;
    const double y = std::exp(rng.uniform(-700, 690));
    EXPECT_NEAR(lanes::log(y), std::log(y), 2e-15 * std::max(1e-3, std::abs(std::log(y)))) << y;
  }
  EXPECT_EQ(lanes::exp(0), 1);
  EXPECT_EQ(lanes::log(1), 0);
  EXPECT_GT(lanes::exp(1e9), 1e307);
  EXPECT_LT(lanes::exp(-1e9), 1e-303);
  EXPECT_TRUE(std::isnan(lanes::exp(NAN)));
}

/// Of one unit from `energy` on, cut into segments at `cuts`.
struct Sample {
  FixedCycles cycles;
  std::vector<FleetCycle> rows;
};

Sample sample(const FixedSum& sum, int count, std::uint64_t seed, double step = 1) {
  Sample made;
  made.rows = fleet_cycles(count, 1, seed);
  Wide before = 0;
  for (const FleetCycle& row : made.rows) {
    FixedCycles& to = made.cycles;
    to.slip_speed.push_back(row.slip_speed);
    to.torque.push_back(row.torque);
    to.temperature.push_back(row.temperature);
    to.closing_time.push_back(row.closing_time);
    to.energy.push_back(std::llrint(step * row.energy / sum.units().energy));
    to.cell.emplace_back();
    to.at.emplace_back();
    sum.place(before, to.cell.back(), to.at.back());
    before += to.energy.back();
  }
  made.cycles.ends = {made.cycles.size()};
  return made;
}

/// All segments together.
FixedTotals total(const FixedSum& sum, const FixedCycles& cycles) {
  FixedTotals all;
  all.sums.assign(sum.sums(), 0);
  const auto workspace = sum.workspace();
  sum.add(cycles, *workspace, [&](std::size_t, const FixedTotals& part) {
    for (std::size_t i = 0; i < all.counts.size(); ++i) all.counts[i] += part.counts[i];
    for (std::size_t i = 0; i < all.sums.size(); ++i) all.sums[i] += part.sums[i];
  });
  return all;
}

TEST(FixedSum, IsTheSumOfTheFormulas) {
  for (const ScatterKind kind : scatter_kinds) {
    const WearModel model = fleet_model(kind);
    const FixedSum sum(model, true);
    const Sample made = sample(sum, 3000, 5);
    const FixedTotals totals = total(sum, made.cycles);
    const std::size_t models = 1 + model.replicates.size();
    std::vector<long double> volumes(models), settleds(models);
    long double variance = 0, energy = 0;
    for (std::size_t i = 0; i < made.rows.size(); ++i) {
      const FleetCycle& row = made.rows[i];
      const OperatingPoint at{row.slip_speed, row.torque, row.temperature, row.closing_time};
      const auto e = static_cast<double>(made.cycles.energy[i]) * sum.units().energy;
      for (std::size_t b = 0; b < models; ++b) {
        const WearPolynomial w = b == 0 ? model.polynomial() : model.replicates[b - 1].w;
        const RunIn& run_in = b == 0 ? model.run_in : model.replicates[b - 1].run_in;
        const double rate = std::max(w(at), 0.0);
        settleds[b] += static_cast<long double>(rate) * e;
        volumes[b] += static_cast<long double>(run_in.g(static_cast<double>(energy))) * rate * e;
      }
      const double step = model.sigma(model.polynomial()(at), at) * e;
      variance += static_cast<long double>(step) * step;
      energy += e;
    }
    const auto near = [&](std::size_t place, double unit, long double expected) {
      EXPECT_NEAR(
          static_cast<double>(static_cast<long double>(totals.sums[place]) * unit / expected), 1,
          2e-12)
          << name_of(kind) << " " << place;
    };
    near(energy_sum, sum.units().energy, energy);
    near(volume_sum, sum.units().fine, volumes[0]);
    near(settled_sum, sum.units().fine, settleds[0]);
    near(variance_sum, sum.units().variance, variance);
    for (std::size_t b = 1; b < models; ++b) {
      near(replicate_sums + b - 1, sum.units().volume, volumes[b]);
      near(replicate_sums + models - 1 + b - 1, sum.units().volume, settleds[b]);
    }
    EXPECT_EQ(totals.counts[counted], 3000);
    EXPECT_GT(totals.counts[negative], 100);
    EXPECT_GT(totals.counts[outside_any], 100);
  }
}

// Blocks, vectors, runs that are added across models, and rows that have to be looked at one by one.
TEST(FixedSum, NoCutNorWayThroughItChangesABit) {
  const FixedSum sum(fleet_model(ScatterKind::exponential), true);
  // Steps of energy so short that many rows lie in a cell, and so long that each has its own.
  for (const double step : {0.02, 1.0, 300.0}) {
    const Sample made = sample(sum, 2000, 6, step);
    const FixedTotals whole = total(sum, made.cycles);
    FixedCycles cut = made.cycles;
    cut.ends.clear();
    Rng rng(7, 0);
    for (std::size_t i = 1; i < cut.size(); i += 1 + static_cast<std::size_t>(9 * rng.uniform()))
      cut.ends.push_back(i);
    cut.ends.push_back(cut.size());
    const FixedTotals parts = total(sum, cut);
    EXPECT_EQ(whole.counts, parts.counts);
    EXPECT_TRUE(whole.sums == parts.sums) << step;

    // One cycle that only 128 bits hold: its block is done the careful way.
    FixedCycles large = made.cycles;
    const std::size_t at = 700;
    FixedCycles alone;
    large.torque[at] *= 1e4;
    alone.slip_speed = {large.slip_speed[at]};
    alone.torque = {large.torque[at]};
    alone.temperature = {large.temperature[at]};
    alone.closing_time = {large.closing_time[at]};
    alone.energy = {large.energy[at]};
    alone.cell = {large.cell[at]};
    alone.at = {large.at[at]};
    alone.ends = {1};
    FixedCycles usual = alone;
    usual.torque = {made.cycles.torque[at]};
    const FixedTotals other = total(sum, large), one = total(sum, alone),
                      instead = total(sum, usual);
    for (std::size_t i = 0; i < whole.sums.size(); ++i)
      EXPECT_TRUE(other.sums[i] == whole.sums[i] - instead.sums[i] + one.sums[i]) << i;
  }
}

TEST(FixedSum, WhatDoesNotFitIsRefused) {
  WearModel model = fleet_model(ScatterKind::linear);
  const FixedSum sum(model, true);
  const FixedCycles usual = sample(sum, 300, 8).cycles;
  const auto refused = [&](FixedCycles cycles) { EXPECT_THROW(total(sum, cycles), InputError); };
  FixedCycles cycles = usual;
  cycles.temperature[200] = 1e12;
  refused(cycles);
  cycles = usual;
  cycles.torque[0] = 1e299;  // infinite less infinite
  refused(cycles);
  cycles = usual;
  cycles.slip_speed[299] = 1e299;
  refused(cycles);
  // Of a number below all normal ones there is a logarithm too.
  cycles = usual;
  cycles.slip_speed[5] = 5e-324;
  EXPECT_NO_THROW(total(sum, cycles));
  model.run_in.fast_energy = 1e-30;
  EXPECT_THROW(FixedSum(model, true), InputError);
}

}  // namespace
}  // namespace wearwell::clutch
