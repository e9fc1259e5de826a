#pragma once

#include <string>

#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// All readings of a store as a table, in the units of the study: Parquet, or CSV. Bytes of the
/// file. Sets `count` to the number of readings. Throws StoreError, MachineError.
std::string readings_as_parquet(Store& store, const prognosis::Tracker& tracker,
                                std::uint64_t& count);
std::string readings_as_csv(Store& store, const prognosis::Tracker& tracker, std::uint64_t& count);

}  // namespace wearwell::monitor
