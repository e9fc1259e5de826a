#include <algorithm>
#include <cctype>
#include <cmath>
#include <tuple>

#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/fleet_seen.h"
#include "wearwell/monitor/time_text.h"

// Queries of a fleet: everything here reads immutable snapshots.
namespace wearwell::monitor {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The view with the message counts, which are kept elsewhere.
UnitView counted(UnitView view, const Tally& tally) {
  const Tally::Counts counts = tally.counts(view.unit);
  view.quality.repeated = counts.repeated;
  view.quality.refused += counts.refused;
  if (!counts.last_problem.empty()) view.quality.last_problem = counts.last_problem;
  return view;
}

}  // namespace

FleetView Fleet::fleet() const {
  FleetView view;
  view.title = settings_.title;
  view.noun = tracker_.noun();
  view.axis = tracker_.axis().name;
  view.axis_unit = tracker_.axis().unit.text;
  view.limited = tracker_.limited();
  view.level_unit = tracker_.limit().unit.text;
  view.limit = tracker_.limit().value;
  view.horizon = reported_.along(settings_.alarm.horizon);
  view.keys_are_times = settings_.keys_are_times;
  for (const prognosis::ReadingColumn& each : tracker_.columns())
    view.columns.push_back({each.name, each.unit.text});
  for (const std::string& each : tracker_.labels()) view.columns.push_back({each, ""});
  if (columns_.level) view.level_column = view.columns[*columns_.level];
  view.trusted = settings_.trusted;
  view.fit = settings_.fit;
  view.fit.since_ms = fit_since_ms_;
  if (settings_.webhook) view.webhook = settings_.webhook();
  const Tally::Total total = tally_.total();
  view.messages = total.messages;
  view.stored = stored_before_ + total.stored;
  view.refused = total.refused;
  view.repeated = total.repeated;
  view.last_message_ms = total.last_message_ms;
  view.now_ms = unix_ms_now();
  view.started_ms = started_ms_;
  const std::lock_guard lock(lock_);
  view.lag_ms = lag_ms_;
  view.units = seen_.size();
  for (const auto& [name, seen] : seen_) {
    const Alarm alarm = seen->view.alarm;
    ++(alarm == Alarm::ok      ? view.ok
       : alarm == Alarm::watch ? view.watch
       : alarm == Alarm::act   ? view.act
       : alarm == Alarm::doubt ? view.doubt
                               : view.unknown);
  }
  return view;
}

std::vector<UnitView> Fleet::units(const std::string& search, std::size_t offset, std::size_t count,
                                   std::uint64_t* matching) const {
  const std::string wanted = lower(search);
  std::vector<std::shared_ptr<const Seen>> found;
  {
    const std::lock_guard lock(lock_);
    for (const auto& [name, seen] : seen_) {
      if (wanted.empty() || lower(name).find(wanted) != std::string::npos) found.push_back(seen);
    }
  }
  // The risk of a unit in doubt is too low to go by; a level beyond the threshold is certain.
  // With equal risk, the unit with less remaining life first; then by name. Units of unknown state
  // come last.
  std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) {
    const auto order = [&](const UnitView& view) {
      const double least = view.beyond ? 1 : view.doubt.empty() ? 0 : settings_.alarm.act;
      return std::tuple(view.service != Service::in_service || (!view.known && least == 0),
                        -std::max(view.risk, least), view.remaining.q05);
    };
    return order(a->view) < order(b->view);
  });
  if (matching) *matching = found.size();
  std::vector<UnitView> views;
  for (std::size_t i = std::min(offset, found.size()); i < found.size() && views.size() < count;
       ++i)
    views.push_back(counted(found[i]->view, tally_));
  return views;
}

std::optional<UnitView> Fleet::view(const std::string& name) const {
  std::shared_ptr<const Seen> seen;
  {
    const std::lock_guard lock(lock_);
    const auto found = seen_.find(name);
    if (found == seen_.end()) return {};
    seen = found->second;
  }
  return counted(seen->view, tally_);
}

std::vector<MovedForecast> Fleet::moved(std::size_t offset, std::size_t count,
                                        std::uint64_t* all) const {
  if (all) *all = moved_.size();
  const std::size_t first = std::min(offset, moved_.size());
  const std::size_t last = first + std::min(count, moved_.size() - first);
  return {moved_.begin() + static_cast<std::ptrdiff_t>(first),
          moved_.begin() + static_cast<std::ptrdiff_t>(last)};
}

std::optional<UnitDetail> Fleet::unit(const std::string& name) const {
  std::shared_ptr<const Seen> seen;
  {
    const std::lock_guard lock(lock_);
    const auto found = seen_.find(name);
    if (found == seen_.end()) return {};
    seen = found->second;
  }
  UnitDetail detail;
  detail.view = counted(seen->view, tally_);
  for (const UnitEvent& each : seen->events->list()) {
    EventView event{each,
                    reported_.along(each.use),
                    reported_.level(each.offset) - reported_.level(0),
                    reported_.level(each.restored) - reported_.level(0),
                    {},
                    seen->events->is_cancelled(each.number)};
    for (std::size_t i = 0; i < each.numbers.size(); ++i)
      event.values.emplace_back(tracker_.columns()[i].name,
                                from_si(tracker_.columns()[i].unit, each.numbers[i]));
    detail.events.push_back(std::move(event));
  }
  detail.held = seen->held;
  detail.judged = seen->judged;
  detail.moments = *seen->moments;
  // The last reading may not be among the kept ones; the present state stands for it.
  const UnitView& view = seen->view;
  if (view.known && (detail.moments.empty() || detail.moments.back().at < view.at)) {
    UnitMoment now;
    now.key = view.last_key;
    now.time_ms = view.last_reading_ms;
    now.at = view.at;
    now.measured = seen->last_measured;
    now.level = view.level;
    now.life = {view.at + view.remaining.q05, view.at + view.remaining.q50,
                view.at + view.remaining.q95};
    detail.moments.push_back(now);
  }
  for (const UnitMoment& each : detail.moments) detail.path.push_back({each.at, each.level});
  std::stable_sort(detail.path.begin(), detail.path.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  // After a repair since the last reading.
  if (view.known && detail.path.back().level.q50 != view.level.q50)
    detail.path.push_back({view.at, view.level});
  for (const UnitDetail::PathPoint& each : path_ahead(*seen)) {
    if (each.at > view.at) detail.path.push_back(each);
  }
  detail.survival = *seen->survival;
  if (const auto at = moved_at_.find(name); at != moved_at_.end())
    detail.moved = moved_[at->second];
  return detail;
}

std::uint64_t Fleet::version() const {
  const std::lock_guard lock(lock_);
  return version_;
}

std::vector<std::string> Fleet::changed_since(std::uint64_t version) const {
  const std::lock_guard lock(lock_);
  std::vector<std::string> names;
  for (auto at = changes_.upper_bound(version); at != changes_.end(); ++at)
    names.push_back(at->second);
  return names;
}

}  // namespace wearwell::monitor
