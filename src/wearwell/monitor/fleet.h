#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "wearwell/monitor/alarm.h"
#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/notices.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/tally.h"
#include "wearwell/monitor/unit_record.h"

namespace wearwell::monitor {

struct FleetSettings {
  std::string title;
  bool trusted = true;     ///< the result that the population was learned from
  std::string population;  ///< SHA-1 of what was learned
  AlarmSettings alarm;
  int threads = 1;
  /// Called with a change of alarm and what was before.
  std::function<void(const AlarmChange& change, Alarm before)> on_alarm = {};
};

/// All units, as they follow from the readings of a store in its order, and as people look at them. One thread calls what is not const;
/// any thread may read. Silence is counted on a clock that does not jump.
class Fleet : public FleetReader {
 public:
  /// All outlive it. Takes up states and alarms that the store has. Throws StoreError.
  Fleet(const prognosis::Tracker& tracker, Store& store, Tally& tally, Notices& notices,
        FleetSettings settings);
  ~Fleet() override;

  /// Takes the next readings of the store; how many. Throws StoreError: then it goes on from there when it is called again.
  std::size_t apply();
  /// Forecasts of units that have changed, each once a second at most, and together in a tenth of the threads' time where that is
  /// less often; for about a tenth of a second; `all`: of every one now. Returns whether none is left that is due. Throws StoreError where a change of alarm cannot be kept; it is told again.
  bool refresh(bool all = false);
  /// States into the store, of the units that have changed since. Throws StoreError.
  void save();
  std::int64_t place() const { return place_; }

  FleetView fleet() const override;
  std::vector<UnitView> units(const std::string& search, std::size_t offset, std::size_t count,
                              std::uint64_t* matching = nullptr) const override;
  std::optional<UnitDetail> unit(const std::string& name) const override;
  std::uint64_t version() const override;
  std::vector<std::string> changed_since(std::uint64_t version) const override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Unit;
  struct Seen;

  Unit& unit_named(const std::string& name);
  void apply_to(Unit& unit, const std::vector<const StoredReading*>& readings);
  void forecast(Unit& unit);
  std::vector<UnitDetail::PathPoint> path_ahead(const Seen& seen) const;
  void hear(Unit& unit, std::int64_t received_ms);
  Alarm shown_alarm(const Unit& unit, Alarm alarm, Clock::time_point now) const;
  void publish(std::vector<Unit*>& units);
  void fall_silent();

  const prognosis::Tracker& tracker_;
  Store& store_;
  Tally& tally_;
  Notices& notices_;
  const FleetSettings settings_;
  const TrackerUnits reported_;
  const std::int64_t started_ms_;

  std::unordered_map<std::string, std::unique_ptr<Unit>> units_;
  std::vector<AlarmChange> unlogged_;
  std::int64_t place_ = 0;
  std::vector<Unit*> stale_;  ///< whose forecast is older than their readings, each once
  std::atomic<bool> any_lost_ = false;
  double forecast_s_ = 0;            ///< of one thread, on the average of the last
  bool live_ = false;                ///< what the store held at the beginning has been taken
  std::uint64_t stored_before_ = 0;  ///< this monitor began
  Clock::time_point silence_checked_ = {}, all_known_ = {};

  mutable std::mutex lock_;  ///< of what follows
  std::map<std::string, std::shared_ptr<const Seen>> seen_;
  std::map<std::uint64_t, std::string> changes_;  ///< by version, each unit once
  std::map<std::string, std::uint64_t> changed_;
  std::uint64_t version_ = 0;
  std::int64_t lag_ms_ = 0;
};

}  // namespace wearwell::monitor
