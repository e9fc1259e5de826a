#pragma once

#include <string>
#include <vector>

#include "wearwell/http/handler.h"
#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// Text in the Prometheus format, with `units` as separate samples (text format 0.0.4; names and
/// units: docs/reference/monitor-api.md).
std::string metrics_text(const FleetView& fleet, const std::vector<UnitView>& units,
                         const HttpCounts& http);

}  // namespace wearwell::monitor
