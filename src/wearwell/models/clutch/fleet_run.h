#pragma once

#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/fleet_report.h"

namespace wearwell::clutch {

/// What is asked of a fleet.
struct FleetRequest {
  std::vector<std::string> columns = {};  ///< as read_fleet_columns has them
  std::vector<std::string> files = {};    ///< for the report; empty: the engines' sources
  std::string prefix = "wearwell";        ///< of the tables made
  bool first = false;                     ///< nothing was counted before
  bool replicates = true;
  /// The statements of ClutchSql even where a loop of our own gives the same sums sooner.
  bool statements = false;
  std::size_t units_in_memory = 0;    ///< of which sums are held; 0: as many as sum_by_loop has it
  std::vector<double> levels;         ///< % of the worn-out volume
  std::vector<double> horizons = {};  ///< further cycles; empty: parts of the mean so far
  std::vector<double> days =
      {};  ///< horizons in days, where the data tell how many cycles a day units make
  double portion_rows = 1e7;  ///< that ClickHouse sorts at once, in some GB
};

/// Sums what is new in each engine, all at once, and makes the fleet's report of the sums of all. Units must not
/// lie in two engines. Nothing is kept by any engine where one fails. Throws InputError for rows that cannot be
/// summed, units in two engines, engines that do not answer; Cancelled.
Result find_fleet(const IdentifiedModel& model, const std::vector<fleet::Engine*>& engines,
                  const FleetRequest& request, const Monitor& monitor);

}  // namespace wearwell::clutch
