#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "wearwell/monitor/monitor_config.h"
#include "wearwell/monitor/population.h"
#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/study/model.h"

namespace wearwell {

/// A monitor's configuration, with the tracker of its units.
struct MonitoredFleet {
  std::shared_ptr<const prognosis::Tracker> tracker;
  std::string fingerprint;  ///< of the fit
  bool trusted = true;
  std::int64_t written_ms = 0;  ///< Unix time of its file
  monitor::MonitorConfig config;
  monitor::ResultSource result;  ///< from which another fit may come; refers to the models

  monitor::Population population() const;
};

/// Throws InputError.
MonitoredFleet monitored_fleet(const std::filesystem::path& config, Models models);

/// Opens its store for reading while a monitor may be running. Throws InputError,
/// monitor::StoreError.
std::unique_ptr<monitor::Store> store_to_read(const MonitoredFleet& fleet);

}  // namespace wearwell
