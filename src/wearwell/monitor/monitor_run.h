#pragma once

#include <functional>
#include <string>

#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/monitor_config.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// The tracker and the settings of a monitor.
struct Population {
  const prognosis::Tracker& tracker;
  std::string fingerprint;  ///< SHA-1 of the population
  bool trusted = true;
};

struct MonitorOptions {
  bool once = false;  ///< processes existing files and standard input, and ends
  int threads = 0;    ///< 0: all
};

/// Reports a started monitor: its fleet, and the page's address, "" if it has no page.
using Begun = std::function<void(const Fleet& fleet, const std::string& address)>;

/// Runs until SIGINT, SIGTERM or SIGHUP, or until all its sources have ended. `started` is called
/// when it accepts readings, `ended` after the last one. Throws InputError before anything is
/// started; MachineError.
void run_monitor(const MonitorConfig& config, const Population& population,
                 const MonitorOptions& options, const Begun& started,
                 const std::function<void(const Fleet&)>& ended);

/// The required content of the store of a configuration.
StoreColumns store_columns(const MonitorConfig& config, const prognosis::Tracker& tracker);

}  // namespace wearwell::monitor
