#pragma once

#include "wearwell/base/monitor.h"
#include "wearwell/fleet/column_engine.h"
#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/energy_balance.h"

namespace wearwell::clutch {

struct LoopSettings {
  bool replicates = true;
  bool first = false;     ///< nothing was counted before
  bool skip_bad = false;  ///< rows that cannot be summed are counted, and left out
  std::size_t units_in_memory = 0;
};

/// The outcome of one scan of the rows.
struct LoopFindings {
  double rows = 0;
  double refused = 0, nameless = 0;  ///< nothing is summed then, without skip_bad
  FleetOutliers outliers;
};

/// Does the work of ClutchSql::query by FixedSum, for an engine within the program: the sums of all
/// new cycles, as integers, added to the stored ones. Rows are taken in their order while the
/// cycles of each unit ascend; otherwise the engine sorts them. Memory holds the sums of
/// `units_in_memory` units, which are then passed to the engine (0: up to a quarter of its memory
/// limit); and for each unit its name and place, some 200 bytes. `engine` and `columns` are the
/// same object. Throws InputError ("out of range") if wear exceeds the range of the sums;
/// Cancelled.
LoopFindings sum_by_loop(fleet::Engine& engine, fleet::ColumnEngine& columns, const ClutchSql& sql,
                         const WearModel& model, const LoopSettings& settings,
                         const Monitor& monitor);

}  // namespace wearwell::clutch
