#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <unordered_map>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"

namespace wearwell::clutch {

/// Cycles per day of units, from the rows of the table: from the first of a unit to its last, or
/// from a column. Assumed exact and constant.
struct FleetDays {
  static constexpr double second = 1, day = 86400 * second;

  bool known = false;  ///< whether the table has any of them
  /// The latest time of all rows, s since 1970; NaN if only rates are known.
  double now = std::numeric_limits<double>::quiet_NaN();
  double mean = 0;           ///< cycles per day, over the units with a rate
  std::size_t borrowed = 0;  ///< units with the default `mean`, without a rate of their own
  std::unordered_map<std::string, double> per_day;

  /// Adds the content of an engine's table. Throws InputError for an impossible rate.
  void read(fleet::Engine& engine, const ClutchSql& sql, const SqlSource& source);
  /// After reading. Throws InputError if no unit has a rate.
  void finish();
  /// Of a unit; `mean` if unknown, which is counted.
  double of(const std::string& unit);
};

/// "2026-11-22", of seconds since 1970 (UTC); empty beyond the year 9999, and for NaN.
std::string day_text(double seconds);

}  // namespace wearwell::clutch
