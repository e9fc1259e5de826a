#pragma once

#include <map>
#include <string>

#include "wearwell/monitor/monitor_run.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/unit_record.h"

namespace wearwell::monitor {

/// All units of a store as their readings have made them until now: the states that it keeps, gone on with the readings behind them,
/// as the monitor does that may be at work beside. Throws StoreError.
std::map<std::string, UnitRecord> stored_units(Store& store, const Population& population);

}  // namespace wearwell::monitor
