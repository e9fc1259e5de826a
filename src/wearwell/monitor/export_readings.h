#pragma once

#include <functional>
#include <string>

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

/// All readings of a store that count as a table, in the units of the study: Parquet, or CSV. They
/// are corrected, without withdrawn ones, and each under the name of its part, with its use since
/// the installation. Bytes of the file. Sets `count` to the number of readings. Throws StoreError, MachineError.
std::string readings_as_parquet(Store& store, const prognosis::Tracker& tracker,
                                std::uint64_t& count);
std::string readings_as_csv(Store& store, const prognosis::Tracker& tracker, std::uint64_t& count);

}  // namespace wearwell::monitor
