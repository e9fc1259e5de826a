#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/fleet_counts.h"
#include "wearwell/present/table.h"
#include "wearwell/study/result.h"

namespace wearwell::clutch {

/// Rows that cannot be summed and were left out (--skip-bad): of each database, as SqlWriter counts
/// them. A row has one reason, the first in this order.
struct LeftOut {
  enum Reason { none, unit, cycle, slip_speed, torque, temperature, closing_time, energy, reasons };
  static constexpr std::size_t most_listed = 1000;

  struct Row {
    std::string unit;
    Reason reason = none;
    double cycle = 0;
    double value = 0;  ///< of the reason's column, SI and degC; NaN if it has none
  };

  bool asked = false;
  double rows = 0;
  std::array<double, reasons> count{}, units{};  ///< rows and units by reason
  std::vector<Row> first = {};                   ///< at most `most_listed` of each database
  std::map<std::string, double> by_unit = {};    ///< rows of each unit with a name

  /// Adds the rows of a database, within its transaction.
  void read(fleet::Engine& engine, const ClutchSql& sql);
  void add(const LeftOut& other);
};

/// How much the rows of a unit might matter: as many cycles at its own mean wear.
struct MissingWear {
  std::string unit;
  double rows = 0, cycles = 0;  ///< left out; summed (0: nothing is known of the unit)
  double volume = 0;            ///< m^3, missing
  double sd = 0;                ///< m^3, of the unit's volume, total
  bool is_large() const { return cycles == 0 || volume > sd; }
};
/// Largest multiple of the standard deviation first, units without any other row before all.
std::vector<MissingWear> missing_wear(const LeftOut& left_out, const std::vector<UnitRow>& units);

/// Nothing is added if no row was left out.
Check left_out_check(const LeftOut& left_out, const std::vector<MissingWear>& wear, double rows);
std::string left_out_sentence(const LeftOut& left_out, const std::vector<MissingWear>& wear,
                              double rows, double fleet_volume);
std::vector<present::Table> left_out_tables(const LeftOut& left_out,
                                            const std::vector<MissingWear>& wear, double rows);
nlohmann::ordered_json left_out_json(const LeftOut& left_out, const std::vector<MissingWear>& wear);

}  // namespace wearwell::clutch
