#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "wearwell/monitor/store.h"
#include "wearwell/monitor/unit_event.h"
#include "wearwell/prognosis/change_watch.h"

namespace wearwell::monitor {

/// A part of a unit: from its installation to the next one.
struct UnitPart {
  std::int64_t number = 1;
  std::int64_t from_key = std::numeric_limits<std::int64_t>::min();
  double from_use = 0;  ///< SI: what the counter showed when it was installed
  Service service = Service::in_service;
  std::int64_t to_key = std::numeric_limits<std::int64_t>::max();  ///< its end, if out of service
  double to_use = std::numeric_limits<double>::quiet_NaN();        ///< SI, on the same counter
};

/// A reading as it counts.
struct CountedReading {
  enum class State { counts, withdrawn, out_of_service };
  State state = State::counts;
  std::int64_t part = 1;  ///< the part that it belongs to
  /// Corrected; its use since the installation, its level without the sensor's offset and as if no
  /// repair had taken anything back.
  StoredReading reading;
  double restored = 0;  ///< SI: what repairs of the part have taken back by then
};

/// All events of one unit, and what its readings are in their light. The readings themselves stay
/// as they were stored.
class UnitEvents {
 public:
  /// Without events.
  UnitEvents() = default;
  UnitEvents(const UnitEvents&) = delete;
  UnitEvents& operator=(const UnitEvents&) = delete;
  /// `events`: of one unit, in the order of storage.
  UnitEvents(std::vector<UnitEvent> events, const prognosis::WatchedColumns& columns,
             bool rising = true);

  CountedReading counted(const StoredReading& reading) const;
  /// At least one; the last one is there now.
  const std::vector<UnitPart>& parts() const { return parts_; }
  const UnitPart& part() const { return parts_.back(); }
  /// SI: what all repairs of the present part have taken back.
  double restored() const;
  const std::vector<UnitEvent>& list() const { return events_; }
  bool is_cancelled(std::int64_t number) const;
  /// Why an event that is stored already does not hold; empty if it does.
  std::string not_in_force(const UnitEvent& event) const;
  /// Number of the last event; 0 if there is none.
  std::int64_t last() const { return events_.empty() ? 0 : events_.back().number; }
  /// Number of the last event that changes the unit's state; 0 if there is none.
  std::int64_t last_of_state() const;
  /// Who has acknowledged the alarm that holds since then, the last one; empty if no one has.
  std::string acknowledged_by(std::int64_t alarm_ms) const;

 private:
  void find_parts(const std::vector<const UnitEvent*>& valid);
  const UnitPart& part_at(std::int64_t key) const;
  double restored_at(const UnitPart& part, std::int64_t key) const;

  prognosis::WatchedColumns columns_ = {};
  std::vector<UnitEvent> events_ = {};
  std::set<std::int64_t> cancelled_ = {};
  std::vector<UnitPart> parts_ = {UnitPart{}};
  bool rising_ = true;
  std::map<std::int64_t, double> offsets_ = {};          // of the sensor, from a key on
  std::map<std::int64_t, double> restored_ = {};         // by a repair, from a key on
  std::map<std::int64_t, const UnitEvent*> edits_ = {};  // of readings, by key
};

/// The events of all units, each with its own.
using EventsOfUnits = std::map<std::string, std::shared_ptr<const UnitEvents>>;
/// All that a store has. Throws StoreError.
EventsOfUnits events_of_units(Store& store, const prognosis::Tracker& tracker);
/// Those of one unit; without events if it has none.
std::shared_ptr<const UnitEvents> events_of(const EventsOfUnits& all, const std::string& unit);

/// The name under which a part is begun and exported: the unit's own for its first part, which may
/// be one of the study, and "M7 (part 2)" for a later one.
std::string part_name(const std::string& unit, std::int64_t part);

/// Why an event cannot be, whatever the unit's readings are; empty if it can.
std::string event_problem(const UnitEvent& event, const prognosis::Tracker& tracker);

}  // namespace wearwell::monitor
