#pragma once

#include <stop_token>

#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/monitor_config.h"
#include "wearwell/monitor/notices.h"

namespace wearwell::monitor {

/// Tells a broker the state of every unit, retained, as PREFIX/UNIT/state, once and then with every change: the JSON of the API. All of
/// them again after every new connection, since a broker may have forgotten.
void publish_states(const FleetReader& reader, const PublishSettings& settings, Notices& notices,
                    std::stop_token stop);

}  // namespace wearwell::monitor
