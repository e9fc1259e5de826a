#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/monitor/store.h"
#include "wearwell/monitor/unit_event.h"
#include "wearwell/prognosis/change_watch.h"
#include "wearwell/prognosis/tracker_units.h"

namespace wearwell::monitor {

/// A part of a unit: from its installation to the next one.
struct UnitPart {
  std::int64_t number = 1;  ///< 1: before the first installation
  std::int64_t from_key = std::numeric_limits<std::int64_t>::min();
  double from_use = 0;     ///< SI: what the counter showed when it was installed
  std::string name = {};   ///< UnitEvent::part of that event
  std::int64_t event = 0;  ///< its number
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
  double offset = 0;    ///< SI: of the sensor then
};

/// Whether it is of a part before the first installation.
inline bool is_of_earlier_part(const CountedReading& seen) {
  return seen.part == 1 && seen.state != CountedReading::State::withdrawn;
}

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
  /// Whether nothing but a reading can be of a part before the first `installed`.
  bool begins_installed() const { return begins_installed_; }
  /// The number of a part for people: its own, and one less if no reading is of a part before the
  /// first `installed`, so that the first part of a unit is part 1.
  std::int64_t shown_part(std::int64_t number, bool earlier_readings) const {
    return number - (begins_installed_ && !earlier_readings);
  }
  /// SI: what repairs of the present part have taken back, all or those up to a key.
  double restored() const { return restored_until(std::numeric_limits<std::int64_t>::max()); }
  double restored_until(std::int64_t key) const { return restored_at(part(), key); }
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
  bool begins_installed_ = false;
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

/// "M7 (part 2)"; of part 1 the unit's own name.
std::string part_name(const std::string& unit, std::int64_t part);
/// "M7 (part 2)" -> "M7", as `part_name` makes it; a name without a part is its own.
std::string unit_of_part(const std::string& name);

/// The name under which a tracker begins the present part of a unit: the one that its event gives,
/// which may be one of the study; else the unit's own, or that of its number, never one of the study.
std::string begun_name(const std::string& unit, const UnitEvents& events,
                       const prognosis::Tracker& tracker);

/// The names under which the parts of a store are exported: those that their events give, else those
/// of their shown numbers.
class PartNames {
 public:
  /// Reads the store. Throws StoreError.
  PartNames(Store& store, const EventsOfUnits& events);
  std::string name(const std::string& unit, std::int64_t part) const;
  /// The same in an export, in which each part has its own. Throws InputError for a second part of
  /// one name: of the unit "M7 (part 2)" and of part 2 of "M7".
  const std::string& exported(const std::string& unit, std::int64_t part);
  /// The units that have a part to which an event gave this name.
  std::set<std::string> units_with(const std::string& name) const;

 private:
  using Part = std::pair<std::string, std::int64_t>;
  std::string described(const Part& part) const;

  std::set<std::string> installed_ = {};  // units whose first part is one that was installed
  std::map<Part, std::string> given_ = {};
  std::map<Part, std::int64_t> events_ = {};  // that began them
  std::map<Part, std::string> exported_ = {};
  std::map<std::string, Part> owners_ = {};  // of exported names
};

/// Why a part cannot have ended where an event says: a reading is farther, at this use, SI, since the
/// installation. Empty if it can, or has not ended.
std::string end_problem(const UnitPart& part, double farthest,
                        const prognosis::TrackerUnits& reported);

/// Why an event cannot be, whatever the unit's readings are; empty if it can.
std::string event_problem(const UnitEvent& event, const prognosis::Tracker& tracker);

}  // namespace wearwell::monitor
