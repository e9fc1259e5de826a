#pragma once

#include <memory>
#include <vector>

#include "wearwell/monitor/fleet.h"

namespace wearwell::monitor {

/// What readers see of a unit: made whole, never changed.
struct Fleet::Seen {
  UnitView view;
  prognosis::Forecast forecast;
  std::shared_ptr<const std::vector<UnitMoment>> moments;
  std::uint64_t held = 0, judged = 0;
};

}  // namespace wearwell::monitor
