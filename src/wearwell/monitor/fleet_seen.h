#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "wearwell/monitor/fleet.h"

namespace wearwell::monitor {

/// A unit as readers see it: built completely, never changed.
struct Fleet::Seen {
  UnitView view;
  std::shared_ptr<const std::vector<UnitDetail::CurvePoint>> survival;
  std::shared_ptr<const std::vector<UnitMoment>> moments;
  std::optional<double> last_measured = {};  ///< as in UnitRecord
  std::uint64_t held = 0, judged = 0;
  std::int64_t place = 0;  ///< of its last processed reading
  std::shared_ptr<const UnitEvents> events;

  /// The forecast band, computed at the first request, for the state at that time.
  struct Ahead {
    explicit Ahead(const Unit& of) : unit(of) {}

    const Unit& unit;
    std::mutex lock = {};
    bool known = false;
    std::vector<UnitDetail::PathPoint> path = {};
  };
  std::shared_ptr<Ahead> ahead;
};

}  // namespace wearwell::monitor
