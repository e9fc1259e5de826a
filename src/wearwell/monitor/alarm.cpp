#include "wearwell/monitor/alarm.h"

namespace wearwell::monitor {

Alarm alarm_named(std::string_view name_of_it) {
  for (const Alarm each : {Alarm::watch, Alarm::act, Alarm::doubt, Alarm::unknown}) {
    if (name_of_it == name(each)) return each;
  }
  return Alarm::ok;
}

Alarm alarm_of_readings(Alarm by_risk, bool beyond, bool in_doubt) {
  if (beyond) return Alarm::act;
  return in_doubt && by_risk != Alarm::act ? Alarm::doubt : by_risk;
}

Alarm alarm_at(double risk, Alarm before, const AlarmSettings& settings) {
  const auto holds = [&](double from, bool on) {
    return risk >= (on ? settings.hysteresis * from : from);
  };
  if (holds(settings.act, before == Alarm::act)) return Alarm::act;
  if (holds(settings.watch, before == Alarm::act || before == Alarm::watch)) return Alarm::watch;
  return Alarm::ok;
}

}  // namespace wearwell::monitor
