#pragma once

#include <stop_token>

#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/monitor_config.h"
#include "wearwell/monitor/notices.h"

namespace wearwell::monitor {

/// Publishes the state of every unit to a broker, retained, as PREFIX/UNIT/state, once and then
/// with every change: the JSON of the API. All of them again after every new connection, since a
/// broker may have lost them.
void publish_states(const FleetReader& reader, const PublishSettings& settings, Notices& notices,
                    std::stop_token stop);

}  // namespace wearwell::monitor
