#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/notices.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/unit_events.h"

namespace wearwell::monitor {

/// Parts of one unit whose readings need not be kept: its first ones, all out of service.
struct OldParts {
  Removal removal;  ///< with all places
  std::size_t parts = 0;
};

/// Empty if there are none: parts that are out of service, of which no reading and no event has
/// arrived since `before_ms` (Unix time), and which are not removed already. Of each part the reading
/// at the largest use and the one with the largest key stay. `axis`: the column of use. Throws
/// StoreError.
std::optional<OldParts> old_parts(Store& store, const std::string& unit, const UnitEvents& events,
                                  std::size_t axis, const RemovedReadings& already,
                                  std::int64_t before_ms);

struct RemovedCounts {
  std::size_t units = 0, parts = 0;
  std::uint64_t readings = 0, forecasts = 0;
};
/// "1200 readings of 3 parts that have been out of service for long"; empty if there are none.
std::string removed_text(const RemovedCounts& counts);

/// What would be removed now. Throws StoreError.
RemovedCounts count_old(Store& store, const prognosis::Tracker& tracker, double keep_s);

/// Removes what is older than `keep_s` from the store, once a day, in short pieces: a kill between two
/// of them leaves a store whose states follow from its readings.
class Retention {
 public:
  using Clock = std::chrono::steady_clock;

  /// `keep_s`: seconds; empty: all is kept. Everything must outlive it.
  Retention(std::optional<double> keep_s, Store& store, const prognosis::Tracker& tracker,
            Notices& notices);

  /// One piece of work on the fleet of the store; false if there is none now. Throws StoreError: the
  /// next call goes on from there.
  bool round(Fleet& fleet);

 private:
  bool is_due();
  void begin(const Fleet& fleet);
  void remove_piece(Fleet& fleet);
  void finish();

  const std::optional<double> keep_s_;
  Store& store_;
  Notices& notices_;
  const std::size_t axis_;
  const std::int64_t started_ms_;
  const Clock::time_point started_;
  std::optional<Clock::time_point> next_ = {};  ///< not before; empty: now
  bool running_ = false;
  std::int64_t before_ms_ = 0;
  std::vector<std::string> waiting_ = {};  ///< units to look at
  std::map<std::string, RemovedReadings> already_ = {};
  std::optional<OldParts> present_ = {};  ///< being removed
  std::size_t removed_ = 0;               ///< of its places
  RemovedCounts counts_ = {};
};

}  // namespace wearwell::monitor
