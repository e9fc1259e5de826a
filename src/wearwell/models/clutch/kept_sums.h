#pragma once

#include <string>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"

namespace wearwell::clutch {

/// What earlier runs left in an engine, and a run is about to add to. Each throws InputError, with what to do instead.

/// Sums with other columns: with replicates where this run has none or the other way round, of other numbers of replicates,
/// or of a version that kept a row for each run. With ClickHouse before the set-up, elsewhere after it.
void refuse_other_layout(fleet::Engine& engine, const ClutchSql& sql, const std::string& prefix);

/// Sums of another model alone, in a file; in a server, sums of the same table by other columns or units. The table may hold only what is
/// new: to begin anew beside those sums would lose what they have counted.
void refuse_others(fleet::Engine& engine, const ClutchSql& sql, const std::string& model,
                   const std::string& prefix);

/// A unit of which more or fewer rows lie before the last cycle counted than were counted.
void refuse_late(fleet::Engine& engine, const ClutchSql& sql);

}  // namespace wearwell::clutch
