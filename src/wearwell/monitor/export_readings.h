#pragma once

#include <functional>
#include <set>
#include <string>

#include "wearwell/monitor/population.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/unit_events.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// All readings of a store in their order, as these events of their units say. Throws StoreError.
void for_each_counted(
    Store& store, const EventsOfUnits& events,
    const std::function<void(const std::string& unit, CountedReading& seen)>& visit);

/// "wear [um]", and "wear" where it has no unit.
std::string column_heading(const prognosis::ReadingColumn& column);

/// The names of the parts whose forecast is in doubt.
using DoubtedParts = std::set<std::string>;
DoubtedParts doubted_parts(Store& store, const Population& population);

struct ExportCounts {
  std::uint64_t readings = 0, doubted = 0;  ///< all; of parts in doubt
};

/// All readings of a store that count as a table, in the units of the study: Parquet, or CSV. They
/// are corrected, without withdrawn ones, and each under the name of its part, with its use since
/// the installation, as if no repair had taken anything back; `doubt` is 1 for readings of parts in
/// doubt, else 0. Bytes of the file. Throws StoreError, MachineError.
std::string readings_as_parquet(Store& store, const prognosis::Tracker& tracker,
                                const DoubtedParts& doubted, ExportCounts& counts);
std::string readings_as_csv(Store& store, const prognosis::Tracker& tracker,
                            const DoubtedParts& doubted, ExportCounts& counts);

}  // namespace wearwell::monitor
