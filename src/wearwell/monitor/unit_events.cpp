#include "wearwell/monitor/unit_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::monitor {
namespace {

bool is_of_study(const prognosis::Tracker& tracker, const std::string& name) {
  const auto study = tracker.seen();
  return std::find(study.begin(), study.end(), name) != study.end();
}

/// Why a part without a name could be one of the study, or another; empty if it could not.
std::string unclear_part(const UnitEvent& event, const prognosis::Tracker& tracker) {
  const std::string unit = printable(event.unit);
  std::int64_t last = 1;  // number of the unit's last part in the study
  for (const std::string& each : tracker.seen()) {
    if (each == event.unit || unit_of_part(each) != event.unit) continue;
    std::int64_t number = 0;
    const char* digits = each.data() + event.unit.size() + std::string_view(" (part ").size();
    if (std::from_chars(digits, each.data() + each.size(), number).ec == std::errc{})
      last = std::max(last, number);
  }
  if (last > 1)
    return fmt::format(
        "the study has the {} '{}'; if it is this part, add part_name = \"{}\"; if this part is "
        "another one, add its name, such as part_name = \"{}\"",
        tracker.noun(), part_name(unit, last), part_name(unit, last), part_name(unit, last + 1));
  if (event.kind != EventKind::installed || !is_of_study(tracker, event.unit)) return {};
  return fmt::format(
      "'{}' is a {} of the study; if it is this part, it goes on without an event where its "
      "counter "
      "does; where the counter does not count from its installation, add part_name = \"{}\", with "
      "what the counter showed then; if another part takes its place, report \"replaced\"",
      unit, tracker.noun(), unit);
}

}  // namespace

UnitEvents::UnitEvents(std::vector<UnitEvent> events, const prognosis::WatchedColumns& columns,
                       bool rising)
    : columns_(columns), events_(std::move(events)), rising_(rising) {
  for (const UnitEvent& each : events_) {
    if (each.kind == EventKind::cancelled) cancelled_.insert(each.cancels);
  }
  std::vector<const UnitEvent*> valid;
  for (const UnitEvent& each : events_) {
    if (each.kind == EventKind::cancelled || !changes_state(each.kind) || is_cancelled(each.number))
      continue;
    valid.push_back(&each);
    if (each.kind == EventKind::sensor) offsets_[each.key] = each.offset;
    if (each.kind == EventKind::repaired) restored_[each.key] = each.restored;
    if (each.kind == EventKind::corrected || each.kind == EventKind::withdrawn)
      edits_[each.key] = &each;  // the last one holds
  }
  find_parts(valid);
}

// Cancelling the cancellation of an event is not possible: the event is reported again.
bool UnitEvents::is_cancelled(std::int64_t number) const {
  return cancelled_.contains(number);
}

std::int64_t UnitEvents::last_of_state() const {
  const auto last = std::find_if(events_.rbegin(), events_.rend(),
                                 [](const UnitEvent& each) { return changes_state(each.kind); });
  return last == events_.rend() ? 0 : last->number;
}

std::string UnitEvents::acknowledged_by(std::int64_t alarm_ms) const {
  const auto last = std::find_if(events_.rbegin(), events_.rend(), [&](const UnitEvent& each) {
    return each.kind == EventKind::acknowledged && each.alarm_ms == alarm_ms &&
           !is_cancelled(each.number);
  });
  return last == events_.rend() ? std::string() : last->author;
}

std::string UnitEvents::not_in_force(const UnitEvent& event) const {
  const auto edits = [](EventKind kind) {
    return kind == EventKind::corrected || kind == EventKind::withdrawn;
  };
  const std::string identity = identity_of(event);
  const auto same = std::find_if(events_.begin(), events_.end(), [&](const UnitEvent& each) {
    return identity_of(each) == identity;
  });
  if (same == events_.end()) return {};
  const auto again = [&](const std::string& what) {
    return fmt::format("this is event {} again, which {}; to report it again, add a note",
                       same->number, what);
  };
  if (is_cancelled(same->number)) return again("is cancelled");
  const auto later = std::find_if(same + 1, events_.end(), [&](const UnitEvent& each) {
    const bool kind = each.kind == same->kind || (edits(each.kind) && edits(same->kind));
    return kind && each.key == same->key && !is_cancelled(each.number);
  });
  return later == events_.end() || same->kind == EventKind::cancelled || !changes_state(same->kind)
             ? std::string()
             : again(fmt::format("event {} has replaced", later->number));
}

void UnitEvents::find_parts(const std::vector<const UnitEvent*>& valid) {
  std::map<std::int64_t, const UnitEvent*> installed;
  for (const UnitEvent* each : valid) {
    if (begins_part(each->kind)) installed[each->key] = each;
  }
  for (const auto& [key, event] : installed) {
    UnitPart part;
    part.number = parts_.back().number + 1;
    part.from_key = key;
    part.from_use = event->use;
    part.name = event->part;
    part.event = event->number;
    parts_.push_back(part);
  }
  for (const UnitEvent* each : valid) {
    if (each->kind != EventKind::removed && each->kind != EventKind::failed) continue;
    // A part that fails and is replaced under one key is the earlier one.
    auto at = std::find_if(parts_.rbegin(), parts_.rend(),
                           [&](const UnitPart& part) { return part.from_key < each->key; });
    if (at == parts_.rend()) at = std::prev(parts_.rend());
    if (each->key > at->to_key) continue;  // of two under one key the last holds
    at->to_key = each->key;
    at->to_use = each->use;
    at->service = each->kind == EventKind::failed ? Service::failed : Service::removed;
  }
  begins_installed_ = !installed.empty() &&
                      installed.begin()->second->kind == EventKind::installed &&
                      parts_.front().service == Service::in_service;
}

const UnitPart& UnitEvents::part_at(std::int64_t key) const {
  auto at = std::find_if(parts_.rbegin(), parts_.rend(),
                         [&](const UnitPart& part) { return part.from_key <= key; });
  return at == parts_.rend() ? parts_.front() : *at;
}

double UnitEvents::restored_at(const UnitPart& part, std::int64_t key) const {
  double sum = 0;
  const auto end = restored_.upper_bound(key);
  for (auto at = restored_.lower_bound(part.from_key); at != end && at != restored_.end(); ++at)
    sum += at->second;
  return sum;
}

CountedReading UnitEvents::counted(const StoredReading& reading) const {
  CountedReading counted{CountedReading::State::counts, 1, reading};
  if (events_.empty()) return counted;
  const UnitPart& part = part_at(reading.key);
  counted.part = part.number;
  if (const auto edit = edits_.find(reading.key); edit != edits_.end()) {
    if (edit->second->kind == EventKind::withdrawn) {
      counted.state = CountedReading::State::withdrawn;
      return counted;
    }
    counted.reading.numbers = edit->second->numbers;
    counted.reading.labels = edit->second->labels;
  }
  if (reading.key > part.to_key) counted.state = CountedReading::State::out_of_service;
  counted.reading.numbers[columns_.axis] -= part.from_use;
  if (columns_.level) {
    const auto offset = offsets_.upper_bound(reading.key);
    if (offset != offsets_.begin()) counted.offset = std::prev(offset)->second;
    counted.reading.numbers[*columns_.level] -= counted.offset;
    counted.restored = restored_at(part, reading.key);
    counted.reading.numbers[*columns_.level] += rising_ ? counted.restored : -counted.restored;
  }
  return counted;
}

EventsOfUnits events_of_units(Store& store, const prognosis::Tracker& tracker) {
  const prognosis::WatchedColumns columns = prognosis::watched_columns(tracker);
  std::map<std::string, std::vector<UnitEvent>> lists;
  for (UnitEvent& each : store.events_after(0)) lists[each.unit].push_back(std::move(each));
  EventsOfUnits all;
  for (auto& [unit, list] : lists)
    all[unit] = std::make_shared<const UnitEvents>(std::move(list), columns, tracker.rising());
  return all;
}

std::shared_ptr<const UnitEvents> events_of(const EventsOfUnits& all, const std::string& unit) {
  static const auto none = std::make_shared<const UnitEvents>();
  const auto found = all.find(unit);
  return found == all.end() ? none : found->second;
}

std::string part_name(const std::string& unit, std::int64_t part) {
  return part == 1 ? unit : fmt::format("{} (part {})", unit, part);
}

std::string unit_of_part(const std::string& name) {
  const std::size_t at = name.rfind(" (part ");
  return at == name.npos || at == 0 || !name.ends_with(')') ? name : name.substr(0, at);
}

std::string begun_name(const std::string& unit, const UnitEvents& events,
                       const prognosis::Tracker& tracker) {
  const UnitPart& part = events.part();
  if (!part.name.empty()) return part.name;
  std::string name = part_name(unit, part.number);
  // A part that no event calls one of the study is new, whatever the study has under its name.
  while (part.number > 1 && is_of_study(tracker, name)) name += "'";
  return name;
}

PartNames::PartNames(Store& store, const EventsOfUnits& events) {
  for (const auto& [unit, list] : events) {
    for (const UnitPart& each : list->parts()) {
      if (!each.name.empty()) given_[{unit, each.number}] = each.name;
      if (each.event > 0) events_[{unit, each.number}] = each.event;
    }
    if (!list->begins_installed()) continue;
    bool earlier = false;
    store.of_unit(unit, 0, std::numeric_limits<std::int64_t>::max(),
                  [&, &list = list](const StoredReading& each) {
                    earlier = earlier || is_of_earlier_part(list->counted(each));
                  });
    if (!earlier) installed_.insert(unit);
  }
}

std::string PartNames::name(const std::string& unit, std::int64_t part) const {
  if (const auto given = given_.find({unit, part}); given != given_.end()) return given->second;
  return part_name(unit, part - (installed_.contains(unit) ? 1 : 0));
}

std::string PartNames::described(const Part& part) const {
  const auto event = events_.find(part);
  return event == events_.end() ? fmt::format("unit '{}'", printable(part.first))
                                : fmt::format("the part of unit '{}' that event {} began",
                                              printable(part.first), event->second);
}

const std::string& PartNames::exported(const std::string& unit, std::int64_t part) {
  const auto [at, is_new] = exported_.try_emplace({unit, part});
  if (!is_new) return at->second;
  at->second = name(unit, part);
  const auto [owner, is_first] = owners_.try_emplace(at->second, at->first);
  if (!is_first)
    throw InputError(fmt::format(
        "two parts have the name '{}': {} and {}; cancel such an event and report it again with "
        "another name in part_name",
        printable(at->second), described(owner->second), described(at->first)));
  return at->second;
}

std::set<std::string> PartNames::units_with(const std::string& name) const {
  std::set<std::string> units;
  for (const auto& [part, given] : given_)
    if (given == name) units.insert(part.first);
  return units;
}

std::string end_problem(const UnitPart& part, double farthest,
                        const prognosis::TrackerUnits& reported) {
  constexpr double rounding = 1e-9;
  if (!(part.to_use - part.from_use < farthest * (1 - rounding))) return {};
  return fmt::format(
      "it is reported as {} at {} = {:.6g}, but has a reading before at {:.6g} on the same "
      "counter: "
      "cancel the wrong event, or withdraw the reading",
      name(part.service), reported.tracker().axis().name, reported.at(part.to_use),
      reported.at(part.from_use + farthest));
}

std::string event_problem(const UnitEvent& event, const prognosis::Tracker& tracker) {
  const std::string what = name(event.kind);
  if (event.author.empty()) return "by is missing: who reports the event";
  const bool begins = begins_part(event.kind);
  const bool needs_use = begins || event.kind == EventKind::failed;
  if (needs_use && std::isnan(event.use))
    return fmt::format("{}: {} is missing: what the counter shows{}", what, tracker.axis().name,
                       begins ? " as the new part is installed (0 if it is set back)" : "");
  if (event.use < 0) return fmt::format("{}: {} is negative", what, tracker.axis().name);
  const std::string part = event.part.empty() ? part_name(event.unit, 2) : event.part;
  const std::string refusal = begins ? tracker.refusal(part) : "";
  if (!refusal.empty()) return fmt::format("{}: {}", what, refusal);
  if (const std::string why = begins && event.part.empty() ? unclear_part(event, tracker) : "";
      !why.empty())
    return fmt::format("{}: {}", what, why);
  if (event.kind != EventKind::sensor && event.kind != EventKind::repaired) return {};
  if (event.kind == EventKind::repaired && !tracker.can_be_restored())
    return fmt::format(
        "repaired: this model does not say how a {} goes on after a repair in part; report "
        "\"replaced\" if it is as good as new",
        tracker.noun());
  const auto level = prognosis::watched_columns(tracker).level;
  if (!level) return fmt::format("{}: no column of a reading measures {}", what, tracker.limited());
  if (event.kind == EventKind::repaired)
    return event.restored > 0
               ? std::string()
               : "repaired: restored must be above 0: the amount that the repair takes back";
  if (!std::isfinite(event.offset))
    return fmt::format("{}: {} is missing: what the sensor shows too much", what,
                       tracker.columns()[*level].name);
  return {};
}

}  // namespace wearwell::monitor
