#include "wearwell/models/clutch/fleet_day_report.h"

#include <fmt/format.h>

#include <cmath>

namespace wearwell::clutch {

using present::digits;
using present::fixed;
using present::given;
using present::Range;
using present::Table;

namespace {

/// "-" if the data have no calendar, or it ends.
std::string day_after(const FleetDays& days, double count) {
  const std::string day = day_text(days.now + count * FleetDays::day);
  return day.empty() ? "-" : day;
}

Table when(const std::string& text) {
  Table table{"when", "Dates", {{"In"}}};
  table.words = true;
  table.rows.push_back({text});
  return table;
}

}  // namespace

double days_of(const UnitRow& unit, double cycles) {
  return cycles > 0 ? cycles / unit.per_day : 0;
}

Table day_table(const FleetCounts& counts, const FleetDays& days) {
  Table table{"days",
              "Units that have reached a level after a number of days, at their own cycles per day",
              {{"Days on", "1", given},
               {"Date"},
               {"Worn", "%", given},
               {"Units", "1", fixed(1)},
               {"95 %", "1", fixed(1), true},
               {"Share of fleet", "%", digits(3)}}};
  for (std::size_t d = 0; d < counts.days().size(); ++d) {
    for (std::size_t l = 0; l < counts.levels().size(); ++l) {
      const UnitCount n = counts.reached(l, counts.horizons().size() + d);
      table.rows.push_back({counts.days()[d], day_after(days, counts.days()[d]),
                            100 * counts.levels()[l], n.expected, Range{n.low, n.high},
                            100 * n.expected / static_cast<double>(counts.units())});
    }
  }
  return table;
}

Table worst_day_table(const FleetFindings& found, std::size_t shown) {
  Table table{"worst-days",
              "Worn-out dates, at the units' own cycles per day",
              {{"Unit"},
               {"Cycles per day", "1", digits(4)},
               {"Days left", "1", present::life(4)},
               {"95 % total", "1", present::life(4), true},
               {"Worn out"},
               {"not before"},
               {"not after"}}};
  for (std::size_t i = 0; i < shown; ++i) {
    const UnitRow& u = found.units[i];
    const double left = days_of(u, u.left), low = days_of(u, u.full.low),
                 high = days_of(u, u.full.high);
    table.rows.push_back({u.unit, u.per_day, left, Range{low, high}, day_after(found.days, left),
                          day_after(found.days, low), day_after(found.days, high)});
  }
  return table;
}

Table when_table(const FleetFindings& found) {
  const FleetDays& days = found.days;
  if (!days.known)
    return when(
        "cycles: the data have no cycles per day (--columns time=COLUMN or cycles_per_day=COLUMN)");
  std::string text =
      std::isnan(days.now)
          ? fmt::format("days from now on, at {:.4g} cycles per day on average", days.mean)
          : fmt::format(
                "days from {} on (UTC), the last of the data, at {:.4g} cycles per day on average; "
                "each unit at its rate between its first and its last row, without uncertainty",
                day_text(days.now), days.mean);
  if (days.borrowed > 0)
    text += fmt::format("; {} units without a rate use the mean", days.borrowed);
  return when(text);
}

void add_days(nlohmann::ordered_json& worst, const UnitRow& u) {
  worst["cycles_per_day"] = u.per_day;
  worst["days_left"] = days_of(u, u.left);
  worst["days_left_full"] = {days_of(u, u.full.low), days_of(u, u.full.high)};
}

void add_days(nlohmann::ordered_json& body, const FleetCounts& counts, const FleetDays& days) {
  auto& by_day = body["levels_by_day"] = nlohmann::ordered_json::array();
  for (std::size_t d = 0; d < counts.days().size(); ++d) {
    for (std::size_t l = 0; l < counts.levels().size(); ++l) {
      const UnitCount n = counts.reached(l, counts.horizons().size() + d);
      by_day.push_back({{"days_on", counts.days()[d]},
                        {"date", day_text(days.now + counts.days()[d] * FleetDays::day)},
                        {"level", counts.levels()[l]},
                        {"units", n.expected},
                        {"low", n.low},
                        {"high", n.high}});
    }
  }
  body["fleet"]["cycles_per_day"] = days.mean;
  body["fleet"]["units_without_rate"] = days.borrowed;
}

}  // namespace wearwell::clutch
