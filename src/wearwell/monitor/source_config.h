#pragma once

#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/monitor_config.h"

namespace wearwell::monitor {

/// Reads [source.NAME], with [reading] or [source.NAME.reading], and adds what is wrong to `problems`. Without a tracker
/// (null) the columns are not checked.
void read_sources(const TomlReader& root, const prognosis::Tracker* tracker, MonitorConfig& config,
                  Problems& problems);

}  // namespace wearwell::monitor
