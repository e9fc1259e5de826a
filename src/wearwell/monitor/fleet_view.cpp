#include "wearwell/monitor/fleet_view.h"

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
  return unit.service == Service::in_service ? name(unit.alarm) : name(unit.service);
}

}  // namespace wearwell::monitor
