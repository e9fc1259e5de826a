#pragma once

#include <string>

#include "wearwell/monitor/fleet_view.h"
#include "wearwell/present/table.h"

namespace wearwell::monitor {

/// The units by risk, for a terminal; at most `most`.
present::Table fleet_table(const FleetReader& reader, std::size_t most);

/// The table with its description.
std::string fleet_text(const FleetReader& reader);

}  // namespace wearwell::monitor
