#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
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
  bool keys_are_times = false;  ///< not sequence numbers
  bool trusted = true;          ///< the result that the population comes from
  std::string population;       ///< SHA-1 of the population
  FitView fit = {};             ///< the same population, for readers
  AlarmSettings alarm;
  int threads = 1;
  /// When the monitor was started, and with how many readings. Without it: now, with those in the
  /// store.
  struct Start {
    std::int64_t time_ms = 0;
    std::uint64_t readings = 0;
  };
  std::optional<Start> start = {};
  /// Whether another fleet of the same store is the one that readers see: until `take_over`, alarms
  /// are neither reported nor stored.
  bool beside = false;
  /// What is sent elsewhere; empty: nothing.
  std::function<WebhookView()> webhook = {};
  /// Called with a change of alarm, the previous alarm, and the unit.
  std::function<void(const AlarmChange& change, Alarm before, const UnitView& unit)> on_alarm = {};
};

/// All units, as they follow from the readings of a store in their order, and as readers see them.
/// One thread calls non-const functions; any thread may read. Silence is measured on a monotonic
/// clock.
class Fleet : public FleetReader {
 public:
  /// All arguments must outlive it. Loads the states and alarms of the store. Throws StoreError.
  Fleet(const prognosis::Tracker& tracker, Store& store, Tally& tally, Notices& notices,
        FleetSettings settings);
  ~Fleet() override;

  /// Readings at once where a request to end is awaited.
  static constexpr std::size_t small_piece = 500;
  /// Processes the next readings of the store, at most so many and none after the place `last`, and
  /// its events; returns the number of readings. Throws StoreError: the next call then continues from
  /// there.
  std::size_t apply(std::int64_t last = std::numeric_limits<std::int64_t>::max(),
                    std::size_t most = 10'000);
  /// Forecasts changed units, each at most once a second, and together at most in a tenth of the
  /// threads' time; runs for about a tenth of a second; `all`: every one now, until `late`. Returns
  /// whether none is left that is due. Throws StoreError if a change of alarm cannot be stored; it is
  /// reported again.
  bool refresh(bool all = false, const std::function<bool()>& late = {});
  /// Processes all readings of the store, makes all forecasts and saves the states; leaves to the next
  /// start what is not done when it is `late`. Returns whether all readings are processed. Throws
  /// StoreError.
  bool finish(const std::function<bool()>& late);
  /// Saves the states of changed units to the store. Throws StoreError.
  void save();
  std::int64_t place() const { return place_; }
  std::int64_t last_event() const { return last_event_; }
  /// Of all units that have events, as far as they are processed.
  const EventsOfUnits& events() const { return events_; }
  /// Readings of this unit are removed: its state follows from those that are left.
  void rebuild(const std::string& unit);
  /// The present alarms of the units follow those of `before`, the fleet that readers see now, as if
  /// it had gone on; what that has not stored yet is stored by this one. To be called before readers see this one.
  void take_over(Fleet& before);
  /// How its fit has moved the forecasts, for readers. To be called before they see it.
  void set_moved(std::int64_t since_ms, std::vector<MovedForecast> moved);

  FleetView fleet() const override;
  std::vector<UnitView> units(const std::string& search, std::size_t offset, std::size_t count,
                              std::uint64_t* matching = nullptr) const override;
  std::optional<UnitDetail> unit(const std::string& name) const override;
  std::optional<UnitView> view(const std::string& name) const override;
  std::vector<MovedForecast> moved(std::size_t offset, std::size_t count,
                                   std::uint64_t* all = nullptr) const override;
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
  void take_events();
  void note_lag(std::int64_t received_ms);

  const prognosis::Tracker& tracker_;
  Store& store_;
  Tally& tally_;
  Notices& notices_;
  const FleetSettings settings_;
  const TrackerUnits reported_;
  const prognosis::WatchedColumns columns_;
  const std::int64_t started_ms_;
  bool beside_;
  std::int64_t fit_since_ms_ = 0;
  std::vector<MovedForecast> moved_;
  std::unordered_map<std::string, std::size_t> moved_at_;  ///< by unit

  std::unordered_map<std::string, std::unique_ptr<Unit>> units_;
  EventsOfUnits events_;
  std::int64_t last_event_ = 0;
  std::vector<AlarmChange> unlogged_;
  std::int64_t place_ = 0;
  std::vector<Unit*> stale_;  ///< units whose forecast is older than their readings, each once
  std::atomic<bool> any_lost_ = false;
  double forecast_s_ = 0;            ///< of one thread, moving average
  bool live_ = false;                ///< everything that the store held at the start is processed
  std::uint64_t stored_before_ = 0;  ///< start of this monitor
  Clock::time_point silence_checked_ = {}, all_known_ = {};

  mutable std::mutex lock_;  ///< of what follows
  std::map<std::string, std::shared_ptr<const Seen>> seen_;
  std::map<std::uint64_t, std::string> changes_;  ///< by version, each unit once
  std::map<std::string, std::uint64_t> changed_;
  std::uint64_t version_ = 0;
  std::int64_t lag_ms_ = 0;
};

}  // namespace wearwell::monitor
