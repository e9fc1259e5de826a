#pragma once

#include <map>
#include <string>

#include "wearwell/monitor/population.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/unit_record.h"

namespace wearwell::monitor {

/// All units of a store in their present state: the stored states, updated with the readings after
/// them, as a running monitor does. Throws StoreError.
std::map<std::string, UnitRecord> stored_units(Store& store, const Population& population);

}  // namespace wearwell::monitor
