#pragma once

#include <fmt/format.h>

#include <memory>

#include "monitor/growth_tracker.h"
#include "support/scratch.h"
#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/intake.h"
#include "wearwell/monitor/monitor_run.h"
#include "wearwell/monitor/unit_record.h"

namespace wearwell::monitor {

/// A fleet of growing units over a store of its own, driven by hand.
class FleetRig : public ScratchTest {
 protected:
  static SourceSettings source() {
    SourceSettings source;
    source.name = "test";
    source.mapping.unit = "machine";
    source.mapping.sequence = "n";
    source.mapping.columns = {{"wear", true, "wear", read_unit("m", "m"), {}},
                              {"time", false, "time", read_unit("h", "s"), {}}};
    return source;
  }
  static StoreColumns columns() { return {{"wear", "time"}, {}, true}; }
  static std::string message(const std::string& unit, int n, double wear, double hours = -1) {
    return fmt::format(R"({{"machine": "{}", "n": {}, "wear": {}, "time": {}}})", unit, n, wear,
                       hours < 0 ? n : hours);
  }

  virtual std::unique_ptr<Store> make_store() {
    return open_store("fleet.sqlite", folder(), columns());
  }
  void open() {
    close();
    store_ = make_store();
    tally_ = std::make_unique<Tally>(most_units_);
    fleet_ = make_fleet();
    intake_ = std::make_unique<Intake>(*store_, *tally_, quiet_, [] {});
    while (fleet_->apply() > 0) {
    }
  }
  void close() {
    intake_.reset();
    fleet_.reset();
    tally_.reset();
    store_.reset();
  }
  virtual std::unique_ptr<Fleet> make_fleet() {
    FleetSettings settings;
    settings.title = "Test";
    settings.population = "population";
    settings.alarm = alarm_;
    settings.threads = threads_;
    settings.on_alarm = [this](const AlarmChange& change, Alarm before, const UnitView&) {
      changes_.push_back(fmt::format("{} {} -> {}", change.unit, name(before), name(change.alarm)));
    };
    return std::make_unique<Fleet>(tracker_, *store_, *tally_, quiet_, settings);
  }
  Delivery deliver(const std::string& payload) {
    const Message message{"", payload};
    return intake_->deliver(source_, std::span(&message, 1));
  }
  void catch_up() {
    while (fleet_->apply() > 0) {
    }
    fleet_->refresh(true);
  }
  /// What is known of all units, to the last bit.
  std::string bits(bool forecasts = true) {
    fleet_->save();
    std::string all;
    std::map<std::string, std::string> states;
    for (const Checkpoint& each : store_->states("population")) {
      UnitRecord record =
          restored_record(each, tracker_, events_of(events_of_units(*store_, tracker_), each.unit));
      record.last_received_ms = 0;  // all but when messages came
      for (UnitMoment& moment : record.moments) moment.time_ms = 0;
      states[each.unit] = bytes_of(record);
    }
    for (const auto& [unit, bytes] : states) all += unit + bytes;
    if (!forecasts) return all;
    for (const UnitView& each : fleet_->units("", 0, SIZE_MAX))
      all += fmt::format("{} {} {} {} {}\n", each.unit, each.risk, each.remaining.q50, each.b10,
                         each.level.q95);
    return all;
  }

  AlarmSettings alarm_ = {100 * 3600.0, 0.05, 0.2, 0.8, {}};
  int threads_ = 2;
  std::size_t most_units_ = 1000;
  std::vector<std::string> changes_;
  GrowthTracker tracker_;
  Notices quiet_{nullptr};
  SourceSettings source_ = source();
  std::unique_ptr<Store> store_;
  std::unique_ptr<Tally> tally_;
  std::unique_ptr<Fleet> fleet_;
  std::unique_ptr<Intake> intake_;
};

}  // namespace wearwell::monitor
