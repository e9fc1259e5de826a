#include "wearwell/monitor/learned_readings.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/unit_events.h"
#include "wearwell/prognosis/change_watch.h"

namespace wearwell::monitor {
namespace {

/// A text file has the digits of a number, in another unit.
constexpr double position_accuracy = 1e-9;

/// Where the study's readings of a unit end, along the axis.
double last_position(const prognosis::Tracker& tracker, const std::string& name) {
  return tracker.begin(name)->forecast().now;
}

std::string learned_text(const prognosis::Tracker& tracker, const std::string& name) {
  return fmt::format(
      "it has learned readings of this store, of {} '{}', which would count twice; use a new store",
      tracker.noun(), printable(name));
}

/// Whether one of the stored readings that count for the part with this name is at `position`.
bool has_reading_at(Store& store, const std::string& unit, const std::string& name,
                    const UnitEvents& events, const PartNames& names, std::size_t axis,
                    double position) {
  bool found = false;
  store.of_unit(unit, 0, std::numeric_limits<std::int64_t>::max(),
                [&](const StoredReading& reading) {
                  const CountedReading counted = events.counted(reading);
                  if (found || counted.state != CountedReading::State::counts ||
                      names.name(unit, counted.part) != name)
                    return;
                  const double at = counted.reading.numbers[axis];
                  found = std::abs(at - position) <= position_accuracy * std::abs(position);
                });
  return found;
}

}  // namespace

std::string learned_units(const prognosis::Tracker& present, const prognosis::Tracker& now,
                          const std::vector<std::string>& units) {
  const std::set<std::string> stored(units.begin(), units.end());
  const std::set<std::string> before(present.seen().begin(), present.seen().end());
  for (const std::string& name : now.seen()) {
    if (!stored.contains(name) && !stored.contains(unit_of_part(name))) continue;
    if (!before.contains(name)) return learned_text(now, name);
    const double earlier = last_position(present, name), later = last_position(now, name);
    if (later - earlier > position_accuracy * std::abs(earlier)) return learned_text(now, name);
  }
  return {};
}

std::string learned_from(Store& store, const prognosis::Tracker& now) {
  const std::size_t axis = prognosis::watched_columns(now).axis;
  const EventsOfUnits events = events_of_units(store, now);
  const PartNames names(store, events);
  for (const std::string& name : now.seen()) {
    std::optional<double> position;  // expensive: only of units with stored readings
    std::set<std::string> candidates = names.units_with(name);
    candidates.insert({name, unit_of_part(name)});
    for (const std::string& unit : candidates) {
      bool any = false;
      store.of_unit(unit, 0, std::numeric_limits<std::int64_t>::max(),
                    [&](const StoredReading&) { any = true; });
      if (!any) continue;
      if (!position) position = last_position(now, name);
      if (*position > 0 &&
          has_reading_at(store, unit, name, *events_of(events, unit), names, axis, *position))
        return learned_text(now, name);
    }
  }
  return {};
}

void refuse_learned(Store& store, const std::string& population, const prognosis::Tracker& now) {
  const std::vector<StoredFit> fits = store.fits();
  if (fits.empty() || fits.back().population == population) return;
  if (const std::string why = learned_from(store, now); !why.empty())
    throw InputError(fmt::format("the result {}: {}", population.substr(0, 7), why));
}

}  // namespace wearwell::monitor
