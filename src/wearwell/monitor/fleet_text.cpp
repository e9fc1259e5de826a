#include "wearwell/monitor/fleet_text.h"

#include <fmt/format.h>

#include "wearwell/base/printable.h"

namespace wearwell::monitor {

present::Table fleet_table(const FleetReader& reader, std::size_t most) {
  using present::Range;
  const FleetView fleet = reader.fleet();
  present::Table table{"fleet", "Units by risk", {}};
  table.columns = {
      {fleet.noun.empty() ? "unit" : fleet.noun},
      {"alarm"},
      {fleet.axis, fleet.axis_unit},
      {fleet.limited, fleet.level_unit},
      {"5 to 95 %", fleet.level_unit, {}, true},
      {"remaining useful life", fleet.axis_unit},
      {"5 to 95 %", fleet.axis_unit, {}, true},
      {"risk", "%", present::digits(3)},
      {"readings", "1", present::given},
  };
  constexpr double percent = 100;
  for (const UnitView& unit : reader.units("", 0, most)) {
    if (!unit.known) {
      table.rows.push_back({printable(unit.unit),
                            shown_state(unit),
                            {},
                            {},
                            {},
                            {},
                            {},
                            {},
                            present::count(unit.quality.readings)});
      continue;
    }
    table.rows.push_back({printable(unit.unit), shown_state(unit), unit.at, unit.level.q50,
                          Range{unit.level.q05, unit.level.q95}, unit.remaining.q50,
                          Range{unit.remaining.q05, unit.remaining.q95}, percent * unit.risk,
                          present::count(unit.quality.readings)});
  }
  return table;
}

std::string fleet_text(const FleetReader& reader) {
  constexpr std::size_t most = 50;
  const FleetView fleet = reader.fleet();
  std::string text;
  if (!fleet.title.empty()) text += printable(fleet.title) + "\n";
  text += fmt::format(
      "{} units: {} act, {} doubt, {} watch, {} ok, {} unknown. Risk: that {} reaches {}{} within "
      "{} {}.\n",
      fleet.units, fleet.act, fleet.doubt, fleet.watch, fleet.ok, fleet.unknown, fleet.limited,
      fleet.limit, fleet.level_unit == "1" ? "" : " " + fleet.level_unit, fleet.horizon,
      fleet.axis_unit);
  text += fmt::format("{} readings stored; of {} messages {} repeated, {} refused.\n", fleet.stored,
                      fleet.messages, fleet.repeated, fleet.refused);
  if (!fleet.trusted)
    text += "The result that the population comes from is not trusted: a check failed.\n";
  text += "\n" + present::text(fleet_table(reader, most));
  for (const UnitView& unit : reader.units("", 0, most)) {
    if (unit.beyond)
      text += fmt::format("{}: the last reading is beyond the limit.\n", printable(unit.unit));
    if (!unit.doubt.empty())
      text += fmt::format("{}: the forecast is in doubt: {}.\n", printable(unit.unit), unit.doubt);
  }
  if (fleet.units > most) text += fmt::format("... and {} more\n", fleet.units - most);
  return text;
}

}  // namespace wearwell::monitor
