#include "wearwell/monitor/fleet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/workers.h"
#include "wearwell/monitor/fleet_unit.h"
#include "wearwell/monitor/time_text.h"

// Longer than others: readings, forecasts, alarms and saved states of the units of one fleet.

namespace wearwell::monitor {

Fleet::Fleet(const prognosis::Tracker& tracker, Store& store, Tally& tally, Notices& notices,
             FleetSettings settings)
    : tracker_(tracker),
      store_(store),
      tally_(tally),
      notices_(notices),
      settings_(std::move(settings)),
      reported_(tracker),
      columns_(prognosis::watched_columns(tracker)),
      started_ms_(settings_.start ? settings_.start->time_ms : unix_ms_now()),
      beside_(settings_.beside),
      fit_since_ms_(settings_.fit.since_ms) {
  place_ = store_.all_up_to(settings_.population);
  events_ = events_of_units(store_, tracker_);
  for (const auto& [unit, events] : events_) last_event_ = std::max(last_event_, events->last());
  for (const Checkpoint& each : store_.states(settings_.population)) {
    Unit& unit = unit_named(each.unit);
    try {
      unit.record = restored_record(each, tracker_, events_of(events_, each.unit));
      unit.lost = false;
      unit.stale = unit.queued = true;
      stale_.push_back(&unit);
    } catch (const InputError& error) {
      unit.lost = any_lost_ = true;
      notices_.tell("store", fmt::format("{}; it is rebuilt from the readings", error.what()));
    }
    hear(unit, unit.record.last_received_ms);
  }
  for (const AlarmChange& each : store_.alarms()) {
    Unit& unit = unit_named(each.unit);
    unit.by_risk = unit.alarm = unit.shown = unit.logged = each.alarm;
    unit.alarm_ms = each.time_ms;
    // What was unknown before the start is not news after it.
    if (!unit.lost) unit.shown = shown_alarm(unit, unit.alarm, Clock::now());
    if (unit.lost) any_lost_ = true;
  }
  for (const auto& [name, events] : events_) {
    Unit& unit = unit_named(name);
    if (events->part().service != Service::in_service) unit.shown = Alarm::unknown;
    if (!unit.lost) continue;
    any_lost_ = true;
    if (events->part().number > 1) unit.by_risk = Alarm::ok;  // as in take_events
  }
  stored_before_ = settings_.start ? settings_.start->readings : store_.count();
}

Fleet::~Fleet() = default;

Fleet::Unit& Fleet::unit_named(const std::string& name) {
  auto& unit = units_[name];
  if (!unit) {
    unit = std::make_unique<Unit>();
    unit->record.unit = name;
    unit->lost = true;  // until it is started, by the thread that processes its readings
    static_cast<void>(tally_.admit(name));
  }
  return *unit;
}

// Ages of readings follow the system clock until the program starts, then a monotonic clock.
void Fleet::hear(Unit& unit, std::int64_t received_ms) {
  const std::int64_t age = live_ ? 0 : std::max<std::int64_t>(0, unix_ms_now() - received_ms);
  unit.heard = Clock::now() - std::chrono::milliseconds(age);
}

std::size_t Fleet::apply(std::int64_t last, std::size_t most) {
  const Clock::time_point asked = Clock::now();
  std::vector<StoredReading> readings = store_.after(place_, most);
  const bool none_left = readings.empty();
  std::erase_if(readings, [last](const StoredReading& each) { return each.place > last; });
  std::map<std::string, std::vector<const StoredReading*>> of_unit;
  for (const StoredReading& each : readings) of_unit[each.unit].push_back(&each);
  take_events();
  if (any_lost_.exchange(false)) {
    for (const auto& [name, unit] : units_) {
      if (unit->lost) of_unit[name];
    }
  }
  std::vector<std::pair<Unit*, const std::vector<const StoredReading*>*>> work;
  for (const auto& [name, list] : of_unit) work.emplace_back(&unit_named(name), &list);
  if (!readings.empty()) note_lag(readings.front().received_ms);
  run_tasks(static_cast<int>(work.size()), settings_.threads, [&](int i) {
    const auto& [unit, list] = work[static_cast<std::size_t>(i)];
    apply_to(*unit, *list);
  });
  for (const auto& [unit, list] : work) {
    if (unit->stale && !std::exchange(unit->queued, true)) stale_.push_back(unit);
  }
  if (readings.empty() && !none_left) return 0;
  if (readings.empty()) {
    live_ = true;
    all_known_ = asked;
    const std::lock_guard lock(lock_);
    lag_ms_ = 0;
    return 0;
  }
  for (const auto& [unit, list] : work) {
    if (!list->empty()) hear(*unit, list->back()->received_ms);
  }
  place_ = readings.back().place;
  note_lag(readings.front().received_ms);
  return readings.size();
}

// For readers, also while readings are processed.
void Fleet::note_lag(std::int64_t received_ms) {
  using std::chrono::milliseconds;
  std::int64_t lag = std::max<std::int64_t>(0, unix_ms_now() - received_ms);
  // No reading from before the start is newer than it, even if the system clock has jumped.
  if (live_)
    lag = std::min<std::int64_t>(
        lag, std::chrono::duration_cast<milliseconds>(Clock::now() - all_known_).count());
  const std::lock_guard lock(lock_);
  lag_ms_ = lag;
}

// A unit with new events is rebuilt from its readings in their light.
void Fleet::take_events() {
  std::map<std::string, std::vector<UnitEvent>> lists;
  for (UnitEvent& each : store_.events_after(last_event_)) {
    last_event_ = each.number;
    auto& list = lists[each.unit];
    if (list.empty()) list = events_of(events_, each.unit)->list();
    list.push_back(std::move(each));
  }
  for (auto& [name, list] : lists) {
    const std::shared_ptr<const UnitEvents> before = events_of(events_, name);
    const std::int64_t part = before->part().number;
    events_[name] =
        std::make_shared<const UnitEvents>(std::move(list), columns_, tracker_.rising());
    Unit& unit = unit_named(name);
    const std::lock_guard lock(unit.moving);
    // An acknowledgement changes no state: it is shown with the next forecast.
    if (!unit.lost && events_[name]->last_of_state() == before->last_of_state()) {
      unit.record.events = events_[name];
      unit.stale = true;
      if (!std::exchange(unit.queued, true)) stale_.push_back(&unit);
      continue;
    }
    unit.lost = any_lost_ = true;
    // A new part knows nothing of earlier alarms.
    if (events_[name]->part().number != part) unit.by_risk = Alarm::ok;
  }
}

void Fleet::apply_to(Unit& unit, const std::vector<const StoredReading*>& readings) {
  std::int64_t received_ms = 0;
  const auto take_one = [&](const StoredReading& each) {
    received_ms = std::max(received_ms, each.received_ms);
    if (each.place <= unit.record.place) return;
    const std::lock_guard lock(unit.moving);
    try {
      take(unit.record, each, reported_, store_);
    } catch (const StoreError&) {
      unit.lost = true;  // possibly in the middle of a reading
      throw;
    } catch (const std::exception& error) {
      ++unit.record.not_counted;
      unit.record.last_problem = error.what();
      notices_.tell("forecasts", fmt::format("unit '{}': {}", unit.record.unit, error.what()));
    }
    unit.stale = unit.unsaved = true;
  };
  try {
    if (unit.lost) {
      const std::int64_t before = readings.empty() ? place_ : readings.front()->place - 1;
      {
        const std::lock_guard lock(unit.moving);
        unit.record =
            begun_record(unit.record.unit, tracker_, events_of(events_, unit.record.unit));
        unit.lost = false;  // from here on it is consistent, if not up to date
        unit.stale = unit.unsaved = true;
      }
      if (before > 0) store_.of_unit(unit.record.unit, 0, before, take_one);
      if (!live_) hear(unit, received_ms);
    }
    for (const StoredReading* each : readings) take_one(*each);
  } catch (const StoreError&) {
    const std::lock_guard lock(unit.moving);
    unit.lost = any_lost_ = true;
    throw;
  }
}

Alarm Fleet::shown_alarm(const Unit& unit, Alarm alarm, Clock::time_point now) const {
  const auto& silence = settings_.alarm.silence;
  if (silence && std::chrono::duration<double>(now - unit.heard).count() > *silence)
    return Alarm::unknown;
  return alarm;
}

bool Fleet::refresh(bool all, const std::function<bool()>& late) {
  constexpr auto slice = std::chrono::milliseconds(100);
  // If forecasting all changed units each second takes more than a tenth of the threads' time, they
  // take turns.
  constexpr double most_of_threads = 0.1;
  const std::chrono::duration<double> between(std::max(
      1.0,
      forecast_s_ * static_cast<double>(stale_.size()) / (most_of_threads * settings_.threads)));
  const Clock::time_point begin = Clock::now();
  std::vector<Unit*> due;
  for (Unit* unit : stale_) {
    if (unit->stale && !unit->lost && (all || begin - unit->forecast_at >= between))
      due.push_back(unit);
  }
  // The longest waiting unit comes first.
  std::sort(due.begin(), due.end(), [](const Unit* a, const Unit* b) {
    return std::pair(a->forecast_at, std::string_view(a->record.unit)) <
           std::pair(b->forecast_at, std::string_view(b->record.unit));
  });
  constexpr std::size_t at_once = 64;
  bool none_left = true;
  for (std::size_t from = 0; from < due.size(); from += at_once) {
    std::vector<Unit*> some(
        due.begin() + static_cast<std::ptrdiff_t>(from),
        due.begin() + static_cast<std::ptrdiff_t>(std::min(from + at_once, due.size())));
    const Clock::time_point started = Clock::now();
    run_tasks(static_cast<int>(some.size()), settings_.threads,
              [&](int i) { forecast(*some[static_cast<std::size_t>(i)]); });
    const double took = std::chrono::duration<double>(Clock::now() - started).count();
    const auto together = std::min<std::size_t>(some.size(), std::max(1, settings_.threads));
    forecast_s_ += 0.1 * (took * static_cast<double>(together) / static_cast<double>(some.size()) -
                          forecast_s_);
    publish(some);
    const bool ends = all ? late && late() : Clock::now() - begin > slice;
    if (ends && from + at_once < due.size()) {
      none_left = false;
      break;
    }
  }
  std::erase_if(stale_,
                [](Unit* unit) { return !unit->stale && std::exchange(unit->queued, false); });
  fall_silent();
  if (!unlogged_.empty()) {
    store_.log(unlogged_);
    unlogged_.clear();
  }
  return none_left;
}

bool Fleet::finish(const std::function<bool()>& late) {
  bool all = false;
  while (!all && !late()) all = apply(std::numeric_limits<std::int64_t>::max(), small_piece) == 0;
  if (all) refresh(true, late);
  save();
  return all;
}

void Fleet::publish(std::vector<Unit*>& units) {
  const Clock::time_point now = Clock::now();
  for (Unit* unit : units) {
    const Alarm before = unit->shown, alarm = shown_alarm(*unit, unit->alarm, now);
    auto seen = std::make_shared<Seen>(*unit->seen);
    const std::string& name = unit->record.unit;
    const AlarmChange change{name, unix_ms_now(), alarm, seen->view.risk, seen->place};
    const bool is_logged =
        !beside_ && alarm != before && alarm != Alarm::unknown && alarm != unit->logged;
    if (is_logged) {
      unlogged_.push_back(change);
      unit->logged = alarm;
      unit->alarm_ms = change.time_ms;
    }
    seen->view.alarm = alarm;
    seen->view.alarm_ms = unit->alarm_ms;
    const bool calls = alarm != Alarm::ok && alarm != Alarm::unknown;
    seen->view.acknowledged_by =
        calls && unit->alarm_ms > 0 ? seen->events->acknowledged_by(unit->alarm_ms) : std::string();
    unit->seen = seen;
    unit->shown = alarm;
    {
      const std::lock_guard lock(lock_);
      seen_[name] = seen;
      std::uint64_t& version = changed_[name];
      changes_.erase(version);
      version = ++version_;
      changes_.emplace(version, name);
    }
    if (alarm != before && !beside_ && settings_.on_alarm)
      settings_.on_alarm(change, before, seen->view);
  }
}

void Fleet::take_over(Fleet& before) {
  std::vector<Unit*> all;
  for (const auto& [name, unit] : units_) {
    const auto found = before.units_.find(name);
    if (found != before.units_.end()) {
      const Unit& old = *found->second;
      unit->shown = old.shown;
      unit->logged = old.logged;
      unit->alarm_ms = old.alarm_ms;
      unit->heard = old.heard;
    }
    if (unit->seen) all.push_back(unit.get());
  }
  beside_ = false;
  live_ = true;
  unlogged_.insert(unlogged_.begin(), before.unlogged_.begin(), before.unlogged_.end());
  before.unlogged_.clear();
  publish(all);
}

void Fleet::set_moved(std::int64_t since_ms, std::vector<MovedForecast> moved) {
  fit_since_ms_ = since_ms;
  moved_ = std::move(moved);
  moved_at_.clear();
  for (std::size_t i = 0; i < moved_.size(); ++i) moved_at_[moved_[i].unit] = i;
}

void Fleet::fall_silent() {
  const Clock::time_point now = Clock::now();
  if (!settings_.alarm.silence || now - silence_checked_ < std::chrono::milliseconds(200)) return;
  silence_checked_ = now;
  std::vector<Unit*> changed;
  for (const auto& [name, unit] : units_) {
    if (unit->seen && shown_alarm(*unit, unit->alarm, now) != unit->shown)
      changed.push_back(unit.get());
  }
  publish(changed);
}

void Fleet::save() {
  // Only changed states; the others are stored already.
  constexpr std::size_t at_once = 500;
  const std::int64_t all_up_to = place_;
  std::vector<Unit*> unsaved;
  for (const auto& [name, unit] : units_) {
    if (unit->lost) return;  // a rebuilt state is saved next time with all readings
    if (unit->unsaved) unsaved.push_back(unit.get());
  }
  const std::int64_t before = store_.all_up_to(settings_.population);
  if (unsaved.empty() && before == all_up_to) return;
  for (std::size_t from = 0;; from += at_once) {
    const std::size_t end = std::min(from + at_once, unsaved.size());
    std::vector<Checkpoint> states(end - from);
    run_tasks(static_cast<int>(states.size()), settings_.threads, [&](int i) {
      const UnitRecord& record = unsaved[from + static_cast<std::size_t>(i)]->record;
      states[static_cast<std::size_t>(i)] = {record.unit, record.place, bytes_of(record)};
    });
    store_.save(settings_.population, states, end == unsaved.size() ? all_up_to : before);
    for (std::size_t i = from; i < end; ++i) unsaved[i]->unsaved = false;
    if (end == unsaved.size()) return;
  }
}

}  // namespace wearwell::monitor
