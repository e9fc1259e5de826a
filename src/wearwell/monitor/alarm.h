#pragma once

#include <optional>
#include <string_view>

#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// Thresholds of the alarms "watch" and "act".
struct AlarmSettings {
  /// horizon along the axis, SI: the risk is that of reaching the failure threshold within it
  double horizon = 0;
  double watch = 0.05, act = 0.2;  ///< risks at which the alarms start
  double hysteresis = 0.8;         ///< an alarm ends below this share of its risk
  std::optional<double> silence;   ///< s without a reading after which a unit becomes unknown
};

/// The alarm after `before` (never unknown) at this risk.
Alarm alarm_at(double risk, Alarm before, const AlarmSettings& settings);

/// The alarm with this one by risk, given the unit's readings: beyond the threshold they call for
/// action whatever the forecast says, and doubt of the forecast comes before any other alarm.
Alarm alarm_of_readings(Alarm by_risk, bool beyond, bool in_doubt);

/// The alarm with this name; ok if there is none.
Alarm alarm_named(std::string_view name);

}  // namespace wearwell::monitor
