#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "wearwell/monitor/monitor_config.h"
#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/study/model.h"

namespace wearwell {

/// What a configuration of a monitor says, with what it follows its units with.
struct MonitoredFleet {
  std::unique_ptr<const prognosis::Tracker> tracker;
  std::string fingerprint;  ///< of what was learned
  bool trusted = true;
  monitor::MonitorConfig config;
};

/// Throws InputError.
MonitoredFleet monitored_fleet(const std::filesystem::path& config, Models models);

/// Its store, to be read beside a monitor that may be at work. Throws InputError, monitor::StoreError.
std::unique_ptr<monitor::Store> store_to_read(const MonitoredFleet& fleet);

}  // namespace wearwell
