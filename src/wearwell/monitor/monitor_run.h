#pragma once

#include <functional>
#include <string>

#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/monitor_config.h"
#include "wearwell/monitor/population.h"
#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

struct MonitorOptions {
  bool once = false;  ///< processes existing files and standard input, and ends
  int threads = 0;    ///< 0: all
};

/// Reports a started monitor: its fleet, and the page's address, "" if it has no page.
using Begun = std::function<void(const FleetReader& fleet, const std::string& address)>;

/// Runs until SIGINT or SIGTERM, or until all its sources have ended. `population` was read from
/// `result`; another fit that is found there later, or at SIGHUP, takes its place. `started` is
/// called when it accepts readings, `ended` after the last one. Throws InputError before anything
/// is started; MachineError.
void run_monitor(const MonitorConfig& config, const Population& population,
                 const ResultSource& result, const MonitorOptions& options, const Begun& started,
                 const std::function<void(const FleetReader&)>& ended);

/// The required content of the store of a configuration.
StoreColumns store_columns(const MonitorConfig& config, const prognosis::Tracker& tracker);

}  // namespace wearwell::monitor
