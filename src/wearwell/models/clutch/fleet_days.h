#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <unordered_map>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"

namespace wearwell::clutch {

/// How many cycles a day units make, by the rows of the table: from the first of a unit to its last, or as a column has it. It is taken as
/// known, and as going on.
struct FleetDays {
  static constexpr double second = 1, day = 86400 * second;

  bool known = false;  ///< whether the table has any of it
  /// The latest moment of all rows, s since 1970; NaN where only rates are known.
  double now = std::numeric_limits<double>::quiet_NaN();
  double mean = 0;           ///< cycles a day, over the units that have a rate
  std::size_t borrowed = 0;  ///< units that were given `mean`, having none of their own
  std::unordered_map<std::string, double> per_day;

  /// Adds what an engine's table has. Throws InputError for a rate that cannot be.
  void read(fleet::Engine& engine, const ClutchSql& sql, const SqlSource& source);
  /// When all was read. Throws InputError where no unit has a rate.
  void finish();
  /// Of a unit; `mean` where nothing tells, which is counted.
  double of(const std::string& unit);
};

/// "2026-11-22", of seconds since 1970 (UTC); empty beyond the year 9999, and for NaN.
std::string day_text(double seconds);

}  // namespace wearwell::clutch
