#include "wearwell/monitor/export_lives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/input/csv_reader.h"
#include "wearwell/monitor/export_readings.h"
#include "wearwell/monitor/unit_events.h"
#include "wearwell/prognosis/tracker_units.h"

namespace wearwell::monitor {
namespace {

struct PartLife {
  double use = 0;     ///< SI, since the installation
  bool seen = false;  ///< in a reading
  bool failed = false;
};

/// What an event says of the end of a part counts more than its last reading.
PartLife ended(PartLife life, const std::string& unit, const UnitPart& part, const UnitPart* next,
               const prognosis::TrackerUnits& reported) {
  life.failed = part.service == Service::failed;
  if (part.to_use <= part.from_use)
    throw InputError(fmt::format(
        "unit '{}' is reported as {} at {} = {:.6g}, but its part was installed at {:.6g} "
        "on the same counter: cancel the wrong event",
        unit, name(part.service), reported.tracker().axis().name, reported.at(part.to_use),
        reported.at(part.from_use)));
  if (const std::string problem = end_problem(part, life.use, reported); !problem.empty())
    throw InputError(fmt::format("unit '{}': {}", unit, problem));
  if (!std::isnan(part.to_use)) {
    life.use = part.to_use - part.from_use;
  } else if (next && next->from_use >= part.from_use + life.use) {
    life.use = next->from_use - part.from_use;  // the counter goes on
  }
  return life;
}

}  // namespace

std::string lives_as_csv(Store& store, const prognosis::Tracker& tracker, std::uint64_t& count) {
  const EventsOfUnits events = events_of_units(store, tracker);
  const std::size_t axis = prognosis::watched_columns(tracker).axis;
  std::map<std::string, std::vector<PartLife>> units;
  for (const auto& [unit, list] : events) units[unit].resize(list->parts().size());
  for_each_counted(store, events, [&](const std::string& unit, CountedReading& seen) {
    if (seen.state != CountedReading::State::counts) return;
    auto& parts = units[unit];
    parts.resize(std::max<std::size_t>(parts.size(), 1));
    PartLife& life = parts[static_cast<std::size_t>(seen.part - 1)];
    life.use = std::max(life.use, seen.reading.numbers[axis]);
    life.seen = true;
  });
  std::string text = fmt::format(
      "{},{},status\n", printable_csv_cell(tracker.noun().empty() ? "unit" : tracker.noun()),
      printable_csv_cell(column_heading(tracker.axis())));
  count = 0;
  PartNames names(store, events);
  const prognosis::TrackerUnits reported(tracker);
  for (const auto& [unit, lives] : units) {
    const auto of_unit = events_of(events, unit);
    const std::vector<UnitPart>& parts = of_unit->parts();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      // Before the first installation there may have been none, or several.
      if (i == 0 && !lives[i].seen && std::isnan(parts[i].to_use)) continue;
      const PartLife life =
          ended(lives[i], unit, parts[i], i + 1 < parts.size() ? &parts[i + 1] : nullptr, reported);
      if (!(life.use > 0)) continue;
      ++count;
      text += fmt::format("{},{},{}\n", printable_csv_cell(names.exported(unit, parts[i].number)),
                          reported.along(life.use), life.failed ? "failed" : "suspended");
    }
  }
  return text;
}

}  // namespace wearwell::monitor
