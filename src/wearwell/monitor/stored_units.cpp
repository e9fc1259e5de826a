#include "wearwell/monitor/stored_units.h"

#include <vector>

#include "wearwell/base/error.h"

namespace wearwell::monitor {

std::map<std::string, UnitRecord> stored_units(Store& store, const Population& population) {
  const TrackerUnits reported(*population.tracker);
  std::map<std::string, UnitRecord> units;
  const EventsOfUnits events = events_of_units(store, *population.tracker);
  // First the position that the states have at least reached: should a monitor save others
  // meanwhile, these have reached farther.
  std::int64_t place = store.all_up_to(population.fingerprint);
  for (const Checkpoint& each : store.states(population.fingerprint)) {
    try {
      units[each.unit] = restored_record(each, *population.tracker, events_of(events, each.unit));
    } catch (const InputError&) {  // damaged, or from before an event: rebuilt from its readings
      UnitRecord fresh = begun_record(each.unit, *population.tracker, events_of(events, each.unit));
      store.of_unit(each.unit, 0, place,
                    [&](const StoredReading& reading) { take(fresh, reading, reported, store); });
      units[each.unit] = std::move(fresh);
    }
  }
  constexpr std::size_t at_once = 10'000;
  for (;;) {
    const std::vector<StoredReading> readings = store.after(place, at_once);
    if (readings.empty()) return units;
    for (const StoredReading& each : readings) {
      auto at = units.find(each.unit);
      if (at == units.end())
        at = units
                 .emplace(each.unit, begun_record(each.unit, *population.tracker,
                                                  events_of(events, each.unit)))
                 .first;
      if (each.place > at->second.place) take(at->second, each, reported, store);
    }
    place = readings.back().place;
  }
}

}  // namespace wearwell::monitor
