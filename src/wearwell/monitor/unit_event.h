#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::monitor {

/// What can happen to a unit, or to one of its stored readings.
enum class EventKind {
  installed,    ///< a part goes into service
  replaced,     ///< a new part is installed in place of another
  repaired,     ///< a part of the wear is taken back
  removed,      ///< the part is taken out of service
  failed,       ///< the part has failed
  sensor,       ///< the sensor is exchanged: from here on it shows the level plus an offset
  corrected,    ///< a reading has other values
  withdrawn,    ///< a reading is not valid
  cancelled,    ///< another event is not valid
  acknowledged  ///< someone has taken notice of the alarm
};
const char* name(EventKind kind);
std::optional<EventKind> event_named(std::string_view name);
/// Whether a new part begins with it.
bool begins_part(EventKind kind);
/// Whether it changes what the readings say: an acknowledgement does not.
bool changes_state(EventKind kind);
/// Whether it may be the first that is known of a unit.
bool begins_unit(EventKind kind);
/// Whether it is about a stored reading, another event or an alarm, so that its unit is there.
bool needs_reference(EventKind kind);
/// The kind in a store. Throws StoreError for another text.
EventKind stored_event(std::string_view name);
/// "replaced, removed, ...", for messages.
std::string event_names();

/// Whether a part is in use, and if not, why.
enum class Service { in_service, removed, failed };
const char* name(Service service);

/// A stored event of a unit. Events are never changed: a wrong one is cancelled by another.
struct UnitEvent {
  std::int64_t number = 0;  ///< in the order of storage, from 1
  std::string unit = {};
  EventKind kind = EventKind::replaced;
  /// Its place among the unit's readings: a key as theirs. Of `corrected` and `withdrawn`: the
  /// reading's; of `cancelled` and `acknowledged`: 0.
  std::int64_t key = 0;
  std::int64_t received_ms = 0;  ///< Unix time of its arrival
  std::string author = {};       ///< who says so
  std::string note = {};
  /// SI, along the axis: what the counter of use shows then; NaN if not given. A counter that is
  /// set back when a part is replaced shows 0.
  double use = std::numeric_limits<double>::quiet_NaN();
  double offset = 0;    ///< SI, of `sensor`: what it shows minus the level
  double restored = 0;  ///< SI, of `repaired`: the amount that is taken back
  /// Of `installed` and `replaced`: the name of the part; one of the study goes on from there. Empty:
  /// a new part, which has the unit's name and its number.
  std::string part = {};
  std::vector<double> numbers = {};      ///< of `corrected`: as StoredReading
  std::vector<std::string> labels = {};  ///< of `corrected`
  std::int64_t cancels = 0;              ///< of `cancelled`: the number of the other event
  std::int64_t alarm_ms = 0;             ///< of `acknowledged`: UnitView::alarm_ms of the alarm
};

/// What an event says beside unit, kind, key, author and note, as JSON for a store.
std::string content_of(const UnitEvent& event);
/// A SHA-1 of all that an event says: the same for the same event that comes again.
std::string identity_of(const UnitEvent& event);
/// Sets these fields. Throws StoreError if the text is damaged.
void read_content(const std::string& json, UnitEvent& event);

}  // namespace wearwell::monitor
