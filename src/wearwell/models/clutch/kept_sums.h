#pragma once

#include <string>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"

namespace wearwell::clutch {

/// Checks of the sums that earlier runs left in an engine, before a run adds to them. Each throws
/// InputError, with the remedy.

/// Sums with other columns: with replicates if this run has none or vice versa, of another number
/// of replicates, or of a version that kept a row for each run. With ClickHouse before the set-up,
/// elsewhere after it.
void refuse_other_layout(fleet::Engine& engine, const ClutchSql& sql, const std::string& prefix);

/// In a file, sums of another model only; in a server, sums of the same table by other columns or
/// units. The table may hold only new rows: starting again would lose what those sums have counted.
void refuse_others(fleet::Engine& engine, const ClutchSql& sql, const std::string& model,
                   const std::string& prefix);

/// A unit with more or fewer rows before the last counted cycle than were counted.
void refuse_late(fleet::Engine& engine, const ClutchSql& sql);

}  // namespace wearwell::clutch
