#pragma once

#include "wearwell/base/monitor.h"
#include "wearwell/fleet/column_engine.h"
#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/energy_balance.h"

namespace wearwell::clutch {

/// What one scan of the rows found.
struct LoopFindings {
  double rows = 0;
  double refused = 0, nameless = 0;  ///< nothing is summed then
  FleetOutliers outliers;
};

/// Does what ClutchSql::query does by FixedSum, for an engine within the program: the sums of all cycles that are new,
/// in whole numbers, added to those kept. Rows are taken as they come while the cycles of each unit ascend; where they do
/// not, the engine sorts them. Sums are held in memory of `units_in_memory` units and then given to the engine (0: up to a quarter
/// of what that may take); and of each unit its name and place, some 200 bytes. `engine` and `columns` are the same. Throws InputError ("out
/// of range") where wear is beyond what the sums hold; Cancelled.
LoopFindings sum_by_loop(fleet::Engine& engine, fleet::ColumnEngine& columns, const ClutchSql& sql,
                         const WearModel& model, bool replicates, bool first,
                         std::size_t units_in_memory, const Monitor& monitor);

}  // namespace wearwell::clutch
