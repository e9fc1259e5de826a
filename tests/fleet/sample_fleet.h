#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/run_command.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// A model with everything that a model can have; its map and those of its replicates are negative at
/// many of `fleet_cycles`, each at others.
inline WearModel fleet_model(ScatterKind kind) {
  constexpr double u = mm3_per_MJ;
  WearModel model;
  model.title = "A fleet's \"model\"";
  model.r = 1.2;
  model.q = 0.5;
  model.terms = {{"1", 0, 0, 0, 0, 1, -4 * u},
                 {"ds*Td", 1, 1, 0, 3e4, 2e5, 22 * u},
                 {"Mz", 0, 0, 1, 20, 60, -9 * u},
                 {"Td*Td*Mz", 0, 2, 1, 3e5, 4e6, 18 * u}};
  model.covariance = Eigen::MatrixXd::Zero(4, 4);
  model.run_in = {0.4, 4, 78e6, 6e6};
  const std::vector<std::vector<double>> p = {{50 * u, 0.02 / u},
                                              {65 * u, 2},
                                              {30 * u, 1, 0.01 / u},
                                              {10 * u, 0.1 * u, 0.2 * u, 0.3 * u, u}};
  model.scatter = {kind, p[static_cast<std::size_t>(kind)]};
  model.scatter_floor = 60 * u;
  model.plate_sd = 0.04;
  model.lowest = {100, 22, 105, 0.6};
  model.highest = {300, 78, 245, 3.8};
  model.worn_out = 2e-7;
  for (int b = 0; b < 5; ++b) {
    WearPolynomial w = model.polynomial();
    for (auto& m : w.monomials) m.coefficient *= 1 + 0.1 * b * (m.torque == 1 ? -1 : 1);
    w.q += 0.1 * (b % 3);
    model.replicates.push_back({w, {0.4 + 0.1 * b, 4, 78e6, 5e6 + 1e6 * b}});
  }
  return model;
}

struct FleetCycle {
  std::string unit;
  long long number = 0;
  double slip_speed = 0, torque = 0, temperature = 0, closing_time = 0, energy = 0;
};

/// Cycles of some units in no order, some of them outside the range.
inline std::vector<FleetCycle> fleet_cycles(int count, int units, std::uint64_t seed) {
  Rng rng(seed, 0);
  std::vector<FleetCycle> cycles;
  std::vector<long long> number(static_cast<std::size_t>(units));
  for (int i = 0; i < count; ++i) {
    const auto unit = static_cast<std::size_t>(static_cast<double>(units) * rng.uniform());
    const OperatingPoint at{rng.uniform(90, 310), rng.uniform(20, 80), rng.uniform(100, 250),
                            rng.uniform(0.5, 4)};
    // Numbers with gaps.
    number[unit] += 1 + static_cast<long long>(3 * rng.uniform());
    cycles.push_back({fmt::format("unit {}", unit + 1), number[unit], at.slip_speed, at.torque,
                      at.temperature, at.closing_time, closing_energy(at)});
  }
  return cycles;
}

inline std::vector<FleetCycle> shuffled(std::vector<FleetCycle> cycles, std::uint64_t seed) {
  Rng rng(seed, 1);
  for (std::size_t i = cycles.size(); i > 1; --i)
    std::swap(cycles[i - 1],
              cycles[static_cast<std::size_t>(static_cast<double>(i) * rng.uniform())]);
  return cycles;
}

inline std::string fleet_csv(const std::vector<FleetCycle>& cycles) {
  std::string text =
      "plate,cycle,slip_speed [rad/s],torque [N m],temperature [degC],closing_time [s],energy "
      "[J]\n";
  for (const FleetCycle& c : cycles)
    text += fmt::format("{},{},{},{},{},{},{}\n", c.unit, c.number, c.slip_speed, c.torque,
                        c.temperature, c.closing_time, c.energy);
  return text;
}

/// summary.json of `wearwell fleet`, which must succeed.
inline nlohmann::json fleet_summary(const std::string& arguments) {
  const CommandResult run = run_wearwell("fleet " + arguments + " --json");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return run.exit_code == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
}

/// A fleet's summary of cycles of which each is at the hour of its number: cycles a day of each unit.
inline void expect_hours(const nlohmann::json& fleet, const std::vector<FleetCycle>& cycles) {
  for (const auto& unit : fleet["worst"]) {
    double count = 0, first = 1e18, last = 0;
    for (const FleetCycle& each : cycles) {
      if (unit["unit"] != each.unit) continue;
      ++count;
      first = std::min(first, static_cast<double>(each.number));
      last = std::max(last, static_cast<double>(each.number));
    }
    EXPECT_NEAR(unit["cycles_per_day"].get<double>() / (24 * (count - 1) / (last - first)), 1,
                1e-9);
  }
  EXPECT_EQ(fleet["fleet"]["units_without_rate"], 0);
  ASSERT_EQ(fleet["levels_by_day"].size(), fleet["levels"].size());
}

/// The largest relative difference of volumes and standard deviations between a fleet's summary and what
/// `wearwell clutch predict` says of the same cycles; counts must be the same.
inline double difference(const nlohmann::json& fleet, const nlohmann::json& predicted) {
  double most = 0;
  std::size_t found = 0;
  for (const auto& p : predicted["plates"]) {
    for (const auto& u : fleet["worst"]) {
      if (u["unit"] != p["plate"]) continue;
      ++found;
      for (const char* key : {"volume", "sd_scatter", "sd_full", "worn"})
        most = std::max(most, std::abs(u[key].get<double>() / p[key].get<double>() - 1));
      EXPECT_EQ(u["cycles"], p["cycles"]);
      EXPECT_EQ(u["outside_any"], p["outside_any"]);
      EXPECT_EQ(u["negative"], p["clamped"]);
    }
  }
  EXPECT_EQ(found, predicted["plates"].size());
  EXPECT_EQ(found, fleet["worst"].size());
  return most;
}

}  // namespace wearwell::clutch
