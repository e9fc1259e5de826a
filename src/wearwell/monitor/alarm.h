#pragma once

#include <optional>
#include <string_view>

#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// When a unit is to be watched, and when to be opened.
struct AlarmSettings {
  double horizon = 0;  ///< along the axis, SI: within which the limit is reached, or not
  double watch = 0.05, act = 0.2;  ///< risks from which on
  double hysteresis = 0.8;         ///< an alarm ends below this share of its risk
  std::optional<double> silence;   ///< s without a reading after which a unit is unknown
};

/// The alarm that follows upon `before` (never unknown) at this risk.
Alarm alarm_at(double risk, Alarm before, const AlarmSettings& settings);

/// The alarm of that name; ok where there is none.
Alarm alarm_named(std::string_view name);

}  // namespace wearwell::monitor
