#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// The server's statistics of itself.
struct HttpCounts {
  std::uint64_t connections = 0, streams = 0;      ///< open now
  std::map<unsigned, std::uint64_t> answers = {};  ///< so far, by status
};

/// Text in the Prometheus format, with `units` as separate samples (text format 0.0.4; names and
/// units: docs/reference/monitor-api.md).
std::string metrics_text(const FleetView& fleet, const std::vector<UnitView>& units,
                         const HttpCounts& http);

}  // namespace wearwell::monitor
