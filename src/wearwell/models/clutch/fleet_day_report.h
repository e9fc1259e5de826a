#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/models/clutch/fleet_report.h"
#include "wearwell/present/table.h"

/// The parts of a fleet's report that tell days, where the data say how many cycles a day units make.
namespace wearwell::clutch {

/// Days that so many cycles of a unit take; infinite where it makes none.
double days_of(const UnitRow& unit, double cycles);

/// Units that have reached a level, by days, each at its own number of cycles a day.
present::Table day_table(const FleetCounts& counts, const FleetDays& days);
/// When the first `shown` units are worn out.
present::Table worst_day_table(const FleetFindings& found, std::size_t shown);
/// What "by when" stands on.
present::Table when_table(const FleetFindings& found);

/// Of a unit in summary.json, and of the whole.
void add_days(nlohmann::ordered_json& worst, const UnitRow& unit);
void add_days(nlohmann::ordered_json& body, const FleetCounts& counts, const FleetDays& days);

}  // namespace wearwell::clutch
