#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/in_service/lives_fleet.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::in_service {

/// Whether the tables of these engines hold readings of units that this tracker follows
/// (reading_columns.h). Throws InputError if some do and some do not.
bool hold_readings(const prognosis::Tracker& tracker, const std::vector<fleet::Engine*>& engines,
                   const std::vector<std::string>& columns);

/// The failures to come of units in service by their readings: each unit is followed from the
/// study's posterior as in the monitor, in one pass over the tables. Throws InputError that names
/// table, column, unit and value; Cancelled.
Result fleet_of_readings(const prognosis::CarriedState& state,
                         std::shared_ptr<const prognosis::Tracker> tracker, Models models,
                         const std::vector<fleet::Engine*>& engines, const LivesRequest& request,
                         const Monitor& monitor);

}  // namespace wearwell::in_service
