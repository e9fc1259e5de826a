#pragma once

#include <functional>
#include <string>

#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// Why a reading cannot be one of any unit of this population, so that it is refused and not
/// stored; empty if it can be. Besides what its tracker refuses (a negative use, an unknown label):
/// a position more than a million times the life of a new unit, a measured level more than 10^12
/// times the threshold. The tracker must outlive the function.
std::function<std::string(const StoredReading& reading)> implausible_reading(
    const prognosis::Tracker& tracker);

/// The same of an event: its use, the offset of a sensor, and an amount that a repair takes back, which is
/// at most ten times the threshold.
std::function<std::string(const UnitEvent& event)> implausible_event(
    const prognosis::Tracker& tracker);

}  // namespace wearwell::monitor
