#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "wearwell/models/clutch/energy_balance.h"
#include "wearwell/models/clutch/fleet_counts.h"
#include "wearwell/models/clutch/fleet_days.h"
#include "wearwell/models/clutch/left_out.h"
#include "wearwell/study/result.h"

namespace wearwell::clutch {

/// The parts of a fleet's report.
struct FleetFindings {
  std::string version, model_id, engine, source;
  std::vector<std::string> files;
  double rows = 0;         ///< read in this run
  FleetOutliers outliers;  ///< among them
  std::string layout;      ///< of text files, if it needs mention
  LeftOut left_out;        ///< with --skip-bad
  bool replicates = true;
  std::vector<UnitRow> units;  ///< worst first
  FleetDays days;
  std::string statements;  ///< that were run
};

/// Sorted by the end of the full interval, earliest first; ties by remaining cycles, then by name.
void worst_first(std::vector<UnitRow>& units);

Result fleet_result(const WearModel& model, const FleetCounts& counts, const FleetFindings& found);

}  // namespace wearwell::clutch
