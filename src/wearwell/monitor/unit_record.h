#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/unit_events.h"
#include "wearwell/prognosis/change_watch.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/prognosis/tracker_units.h"

namespace wearwell::monitor {

/// The state of a unit, which follows from its readings in the order of storage and from its events:
/// the same after a restart.
struct UnitRecord {
  std::string unit;
  /// The readings of its present part alone count.
  std::shared_ptr<const UnitEvents> events = {};
  std::string part = {};  ///< `begun_name` of its present part
  std::unique_ptr<prognosis::TrackedUnit> state;
  std::int64_t place = 0;  ///< of its last processed reading
  std::uint64_t readings = 0, late = 0, contradicting = 0, not_counted = 0;
  std::uint64_t held = 0, judged = 0;  ///< readings within 5 to 95 % of their forecast
  std::string last_problem = {};
  bool earlier_readings =
      false;                    ///< of a part before the first `installed` (UnitEvents::shown_part)
  std::int64_t last_key = 0;    ///< the largest
  std::int64_t stored_key = 0;  ///< the largest, also of readings that do not count
  std::int64_t last_time_ms = 0, last_received_ms = 0;
  /// Level of the last reading in order, in the units of the study, as it was measured.
  std::optional<double> last_measured = {};
  std::vector<UnitMoment> moments = {};
  prognosis::ChangeWatch watch = {};
};

using prognosis::risk_within;
using prognosis::TrackerUnits;

/// The displayed curve of lives: a forecast is a hundred times as large, and every unit has one.
std::vector<UnitDetail::CurvePoint> survival_curve(const prognosis::WeightedLives& lives,
                                                   const TrackerUnits& reported);

/// Processes a reading after all earlier ones. Reads the history from the store when nodes are
/// rebuilt. If it throws StoreError the record must be rebuilt (begun_record).
void take(UnitRecord& record, const StoredReading& reading, const TrackerUnits& units,
          Store& store);

/// The readings of a unit up to a place of storage that count for its present part, as they count.
/// The store must outlive it.
prognosis::History counted_history(const UnitRecord& record, std::int64_t until, Store& store);

/// Whether the n-th reading is kept in the history: all at first, then ever fewer, so that a
/// thousand more need little more memory.
bool is_kept_moment(std::uint64_t n);

UnitRecord begun_record(const std::string& unit, const prognosis::Tracker& tracker,
                        std::shared_ptr<const UnitEvents> events);

std::string bytes_of(const UnitRecord& record);
/// Throws InputError if the bytes are damaged, or from before the last event.
UnitRecord restored_record(const Checkpoint& checkpoint, const prognosis::Tracker& tracker,
                           std::shared_ptr<const UnitEvents> events);

}  // namespace wearwell::monitor
