#include "wearwell/monitor/fleet_view.h"

#include "wearwell/monitor/unit_events.h"

namespace wearwell::monitor {

const char* name(Alarm alarm) {
  switch (alarm) {
    case Alarm::ok:
      return "ok";
    case Alarm::watch:
      return "watch";
    case Alarm::act:
      return "act";
    case Alarm::doubt:
      return "doubt";
    case Alarm::unknown:
      break;
  }
  return "unknown";
}

std::string shown_state(const UnitView& unit) {
  return unit.service == name(Service::in_service) ? name(unit.alarm) : unit.service;
}

}  // namespace wearwell::monitor
