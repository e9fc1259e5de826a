#pragma once

#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/fleet_report.h"

namespace wearwell::clutch {

/// The request for a fleet.
struct FleetRequest {
  std::vector<std::string> columns = {};  ///< in the form of read_fleet_columns
  std::vector<std::string> files = {};    ///< for the report; default: the engines' sources
  std::string prefix = "wearwell";        ///< prefix of the created tables
  bool first = false;                     ///< nothing was counted before
  bool read_only = false;                 ///< create no table: all cycles in one query (PostgreSQL)
  bool skip_bad = false;                  ///< leave out rows that cannot be summed, and report them
  bool replicates = true;
  /// Use the statements of ClutchSql even if the built-in loop gives the same sums faster.
  bool statements = false;
  std::size_t units_in_memory = 0;    ///< units with sums in memory; 0: the default of sum_by_loop
  std::vector<double> levels;         ///< % of the worn-out volume
  std::vector<double> horizons = {};  ///< horizons in cycles; empty: fractions of the mean so far
  std::vector<double> days =
      {};                     ///< horizons in days, if the data give the cycles per day of units
  double portion_rows = 1e7;  ///< number that ClickHouse sorts at once, in some GB
};

/// Sums the new cycles in each engine, all in parallel, and makes the fleet's report from all sums.
/// A unit must not be in two engines. If one engine fails, no engine keeps anything. Throws
/// InputError for rows that cannot be summed, units in two engines, engines that do not answer;
/// Cancelled.
Result find_fleet(const IdentifiedModel& model, const std::vector<fleet::Engine*>& engines,
                  const FleetRequest& request, const Monitor& monitor);

}  // namespace wearwell::clutch
