#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/models/clutch/fleet_report.h"
#include "wearwell/present/table.h"

/// The parts of a fleet's report in days, if the data give the cycles per day of units.
namespace wearwell::clutch {

/// Days for this number of cycles of a unit; infinite if it makes none.
double days_of(const UnitRow& unit, double cycles);

/// Units that have reached a level, by days, each at its own cycles per day.
present::Table day_table(const FleetCounts& counts, const FleetDays& days);
/// When the first `shown` units are worn out.
present::Table worst_day_table(const FleetFindings& found, std::size_t shown);
/// The basis of the dates.
present::Table when_table(const FleetFindings& found);

/// For a unit in summary.json, and for the whole.
void add_days(nlohmann::ordered_json& worst, const UnitRow& unit);
void add_days(nlohmann::ordered_json& body, const FleetCounts& counts, const FleetDays& days);

}  // namespace wearwell::clutch
