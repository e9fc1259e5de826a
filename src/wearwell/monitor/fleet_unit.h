#pragma once

#include <memory>
#include <mutex>

#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/fleet_seen.h"

namespace wearwell::monitor {

/// A unit as the thread that processes readings knows it.
struct Fleet::Unit {
  UnitRecord record;
  mutable std::mutex moving;  ///< locked when `record.state` changes, and by other readers of it
  bool lost = false;          ///< the record must be rebuilt
  bool unsaved = false, stale = false, queued = false;
  Alarm by_risk = Alarm::ok;  ///< of its risk alone
  Alarm alarm = Alarm::ok;
  Alarm shown = Alarm::ok, logged = Alarm::ok;
  std::int64_t alarm_ms = 0;  ///< Unix time of the change to `logged`
  Clock::time_point heard = {}, forecast_at = {};
  std::shared_ptr<const Seen> seen;
};

}  // namespace wearwell::monitor
