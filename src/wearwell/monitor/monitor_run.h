#pragma once

#include <functional>
#include <string>

#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/monitor_config.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// What a monitor follows its units with.
struct Population {
  const prognosis::Tracker& tracker;
  std::string fingerprint;  ///< SHA-1 of what was learned
  bool trusted = true;
};

struct MonitorOptions {
  bool once = false;  ///< reads what is there in files and on standard input, and ends
  int threads = 0;    ///< 0: all
};

/// Tells where a monitor that has begun can be seen: its fleet, and the page's address, "" where it serves none.
using Begun = std::function<void(const Fleet& fleet, const std::string& address)>;

/// Runs until SIGINT, SIGTERM or SIGHUP, or until all its sources have ended. `started` is called when it takes readings, `ended`
/// when it has taken the last. Throws InputError: nothing was begun; MachineError.
void run_monitor(const MonitorConfig& config, const Population& population,
                 const MonitorOptions& options, const Begun& started,
                 const std::function<void(const Fleet&)>& ended);

/// What the store of a configuration must hold.
StoreColumns store_columns(const MonitorConfig& config, const prognosis::Tracker& tracker);

}  // namespace wearwell::monitor
