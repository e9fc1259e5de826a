#pragma once

#include <string>

#include "wearwell/monitor/fleet_view.h"
#include "wearwell/present/table.h"

namespace wearwell::monitor {

/// The units by risk, as a terminal shows them; `most` of them.
present::Table fleet_table(const FleetReader& reader, std::size_t most);

/// The table and what it is of.
std::string fleet_text(const FleetReader& reader);

}  // namespace wearwell::monitor
