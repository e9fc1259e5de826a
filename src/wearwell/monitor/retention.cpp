#include "wearwell/monitor/retention.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/monitor/fleet_unit.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {
namespace {

constexpr std::int64_t no_end = std::numeric_limits<std::int64_t>::max();
constexpr auto between_passes = std::chrono::hours(24);

/// How many of a unit's first parts are out of service, and have no event since `before_ms`.
std::size_t ended_parts(const UnitEvents& events, std::int64_t before_ms) {
  std::size_t ended = 0;
  const std::vector<UnitPart>& parts = events.parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool is_last = i + 1 == parts.size();
    if (is_last && parts[i].service == Service::in_service) break;
    const std::int64_t end = is_last ? no_end : parts[i + 1].from_key;
    const bool recent =
        std::any_of(events.list().begin(), events.list().end(), [&](const UnitEvent& each) {
          return changes_state(each.kind) && each.key <= end && each.received_ms >= before_ms;
        });
    if (recent) break;
    ++ended;
  }
  return ended;
}

/// The readings of one part, and which of them stay.
struct PartReadings {
  std::vector<std::int64_t> places = {};
  std::int64_t newest_ms = 0;
  std::optional<StoredReading> last = {}, farthest = {};

  void add(const StoredReading& stored, const CountedReading& seen, std::size_t axis) {
    places.push_back(stored.place);
    newest_ms = std::max(newest_ms, stored.received_ms);
    if (!last || stored.key > last->key) last = stored;
    if (seen.state != CountedReading::State::counts) return;
    if (!farthest || seen.reading.numbers[axis] > farthest->numbers[axis]) {
      farthest = seen.reading;
      farthest->place = stored.place;
    }
  }
  bool stays(std::int64_t place) const {
    return (last && last->place == place) || (farthest && farthest->place == place);
  }
};

}  // namespace

std::optional<OldParts> old_parts(Store& store, const std::string& unit, const UnitEvents& events,
                                  std::size_t axis, const RemovedReadings& already,
                                  std::int64_t before_ms) {
  const std::vector<UnitPart>& parts = events.parts();
  std::size_t count = ended_parts(events, before_ms);
  const auto is_removed = [&](std::size_t n) {  // the first n parts
    return n < parts.size() ? already.before_key >= parts[n].from_key
                            : already.before_key > parts[n - 1].to_key;
  };
  if (count == 0 || (already.done && is_removed(count))) return {};
  std::vector<PartReadings> readings(parts.size());
  store.of_unit(unit, 0, no_end, [&](const StoredReading& each) {
    const CountedReading seen = events.counted(each);
    readings[static_cast<std::size_t>(seen.part - 1)].add(each, seen, axis);
  });
  for (std::size_t i = 0; i < count; ++i)
    if (readings[i].newest_ms >= before_ms) count = i;
  if (count == 0 || (already.done && is_removed(count))) return {};
  OldParts old;
  old.parts = count;
  Removal& removal = old.removal;
  removal.unit = unit;
  removal.last_event = events.last();
  removal.drops_state = count == parts.size();
  if (count < parts.size()) {
    removal.before_key = std::max(already.before_key, parts[count].from_key);
  } else {
    const std::optional<StoredReading>& last = readings.back().last;
    removal.before_key = std::max({already.before_key, parts.back().to_key, last ? last->key : 0});
    if (removal.before_key < no_end) ++removal.before_key;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (const std::int64_t place : readings[i].places)
      if (!readings[i].stays(place)) removal.places.push_back(place);
  }
  return old;
}

std::string removed_text(const RemovedCounts& counts) {
  if (counts.readings == 0) return {};
  return fmt::format("{} reading{} of {} part{} out of service", counts.readings,
                     counts.readings == 1 ? "" : "s", counts.parts, counts.parts == 1 ? "" : "s");
}

RemovedCounts count_old(Store& store, const prognosis::Tracker& tracker, double keep_s) {
  const std::int64_t before_ms = unix_ms_now() - std::llround(1000 * keep_s);
  const std::size_t axis = prognosis::watched_columns(tracker).axis;
  const std::map<std::string, RemovedReadings> already = store.removed();
  RemovedCounts counts;
  for (const auto& [unit, events] : events_of_units(store, tracker)) {
    const auto found = already.find(unit);
    const auto old =
        old_parts(store, unit, *events, axis,
                  found == already.end() ? RemovedReadings() : found->second, before_ms);
    if (!old || old->removal.places.empty()) continue;
    ++counts.units;
    counts.parts += old->parts;
    counts.readings += old->removal.places.size();
  }
  return counts;
}

Retention::Retention(std::optional<double> keep_s, Store& store, const prognosis::Tracker& tracker,
                     Notices& notices)
    : keep_s_(keep_s),
      store_(store),
      notices_(notices),
      axis_(prognosis::watched_columns(tracker).axis),
      started_ms_(unix_ms_now()),
      started_(Clock::now()) {}

// What is removed cannot be had back, so a clock that has jumped removes nothing.
bool Retention::is_due() {
  constexpr double most_drift = 3600;  // s
  const Clock::time_point now = Clock::now();
  if (!keep_s_ || (next_ && now < *next_)) return false;
  const double by_clock = 1e-3 * static_cast<double>(unix_ms_now() - started_ms_);
  const double drift = by_clock - std::chrono::duration<double>(now - started_).count();
  if (std::abs(drift) < most_drift) return true;
  next_ = now + between_passes;
  notices_.tell("store",
                fmt::format("the clock of this machine has moved by {:.3g} h since the start: old "
                            "readings are removed (store.keep) after a restart",
                            drift / 3600));
  return false;
}

void Retention::begin(const Fleet& fleet) {
  before_ms_ = unix_ms_now() - std::llround(1000 * *keep_s_);
  already_ = store_.removed();
  waiting_.clear();
  for (const auto& [unit, events] : fleet.events()) {
    if (ended_parts(*events, before_ms_) > 0) waiting_.push_back(unit);
  }
  counts_ = {};
  next_ = Clock::now() + between_passes;
  running_ = true;
}

void Retention::remove_piece(Fleet& fleet) {
  constexpr std::size_t at_once = 2000;
  const Removal& all = present_->removal;
  const std::size_t end = std::min(removed_ + at_once, all.places.size());
  Removal piece = all;
  piece.places.assign(all.places.begin() + static_cast<std::ptrdiff_t>(removed_),
                      all.places.begin() + static_cast<std::ptrdiff_t>(end));
  piece.done = end == all.places.size();
  const bool is_removed = store_.remove(piece);
  if (is_removed) counts_.readings += piece.places.size();
  removed_ = end;
  // With another event the parts are no longer what they were: the next pass looks again.
  if (is_removed && !piece.done) return;
  if (is_removed && !all.places.empty()) {
    ++counts_.units;
    counts_.parts += present_->parts;
  }
  if (all.drops_state && !all.places.empty()) fleet.rebuild(all.unit);
  present_.reset();
}

bool Retention::round(Fleet& fleet) {
  constexpr auto slice = std::chrono::milliseconds(20);
  if (!running_) {
    if (!is_due()) return false;
    begin(fleet);
  }
  const Clock::time_point end = Clock::now() + slice;
  while (Clock::now() < end) {
    if (present_) {
      remove_piece(fleet);
    } else if (!waiting_.empty()) {
      const std::string unit = waiting_.back();
      const auto found = already_.find(unit);
      present_ = old_parts(store_, unit, *events_of(fleet.events(), unit), axis_,
                           found == already_.end() ? RemovedReadings() : found->second, before_ms_);
      removed_ = 0;
      waiting_.pop_back();
    } else {
      finish();
      return false;
    }
  }
  return true;
}

void Retention::finish() {
  counts_.forecasts = store_.remove_forecasts(before_ms_);
  running_ = false;
  const std::string readings = removed_text(counts_);
  if (readings.empty() && counts_.forecasts == 0) return;
  notices_.tell(
      "store",
      fmt::format(
          "removed from before {} (store.keep): {}{}{}", iso_of_unix_ms(before_ms_), readings,
          !readings.empty() && counts_.forecasts > 0 ? ", " : "",
          counts_.forecasts > 0
              ? fmt::format("{} alarm{} or moved forecast{}", counts_.forecasts,
                            counts_.forecasts == 1 ? "" : "s", counts_.forecasts == 1 ? "" : "s")
              : ""));
}

void Fleet::rebuild(const std::string& unit) {
  Unit& removed = unit_named(unit);
  const std::lock_guard lock(removed.moving);
  removed.lost = any_lost_ = true;
}

}  // namespace wearwell::monitor
