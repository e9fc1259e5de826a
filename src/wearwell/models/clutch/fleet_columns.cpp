#include "wearwell/models/clutch/fleet_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/fleet/named_columns.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/labelled.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell::clutch {
namespace {

const std::vector<std::string> names = {"unit",   "cycle",       "slip_speed",
                                        "torque", "temperature", "closing_time",
                                        "energy", "time",        "cycles_per_day"};

/// All columns that neither the options nor the table's names give, in one message.
void require_given(const std::map<std::string, std::string>& given,
                   const std::vector<std::string>& headings, const std::string& table) {
  if (headings.empty()) return;
  std::vector<std::string> missing, options, shown;
  const auto look = [&](const char* name, const char* heading, const char* si) {
    if (given.contains(name)) return;
    const bool found = std::any_of(headings.begin(), headings.end(), [&](const std::string& each) {
      return each == heading || (si && read_heading(each, si).name == heading);
    });
    if (found) return;
    missing.push_back(si ? fmt::format("'{} [{}]'", heading, fleet::usual_unit(si))
                         : fmt::format("'{}'", heading));
    const std::string option =
        fmt::format("{}=COLUMN{}", name, si ? fmt::format(":{}", fleet::usual_unit(si)) : "");
    options.push_back(option.find(' ') == option.npos ? option : "'" + option + "'");
  };
  look("unit", "plate", nullptr);
  look("cycle", "cycle", nullptr);
  for (const Input& input : inputs) look(input.name, input.name, input.si);
  look("energy", "energy", "J");
  if (missing.empty()) return;
  constexpr std::size_t most_shown = 30;
  for (std::size_t i = 0; i < std::min(headings.size(), most_shown); ++i)
    shown.push_back("'" + printable(shortened(headings[i])) + "'");
  if (headings.size() > most_shown) shown.emplace_back("...");
  throw InputError(fmt::format(
      "{} has no column {}; it has {}. State the columns, with the units that their values have: "
      "--columns {}",
      table, fmt::join(missing, ", "), fmt::join(shown, ", "), fmt::join(options, " ")));
}

/// "M:N m", "torque [N m]".
SqlColumn with_unit(const std::string& name, const std::string& text, const char* si) {
  const fleet::UnitColumn found = fleet::column_with_unit(name, text, si);
  const Unit& unit = found.unit;
  return {found.column, unit.scale, unit.offset, false, unit.text, found.unit_by_option};
}

}  // namespace

std::string unit_column(const std::vector<std::string>& options) {
  const auto given = fleet::split_columns(options, names);
  const auto at = given.find("unit");
  return at == given.end() ? "plate" : at->second;
}

void read_fleet_columns(const std::vector<std::string>& options,
                        const std::vector<fleet::EngineColumn>& known, const std::string& table,
                        SqlSource& source) {
  const std::map<std::string, std::string> given = fleet::split_columns(options, names);
  std::vector<std::string> headings;
  for (const auto& each : known) {
    headings.push_back(each.name);
    if (each.text_decimal != 0) source.text_decimal = each.text_decimal;
  }
  require_given(given, headings, table);
  const auto plain = [&](const char* name, const char* otherwise, bool is_number) {
    const auto at = given.find(name);
    SqlColumn column{at == given.end() ? otherwise : at->second};
    fleet::require_column(known, column.name, table, is_number);
    for (const auto& each : known) column.is_real |= each.name == column.name && each.is_real;
    return column;
  };
  const auto quantity = [&](const char* name, const char* si) {
    const auto at = given.find(name);
    SqlColumn column;
    if (at != given.end()) {
      column = with_unit(name, at->second, si);
    } else if (known.empty()) {
      throw InputError(fmt::format(
          "--columns needs the column of '{0}', and its unit: '{0}=COLUMN:{1}'", name, si));
    } else {
      const ColumnChoice found = find_labelled(headings, name, si, table, "--columns");
      column = {found.column, found.unit.scale, found.unit.offset, false, found.unit.text};
    }
    fleet::require_column(known, column.name, table, true);
    return column;
  };
  source.unit = plain("unit", "plate", false);
  source.cycle = plain("cycle", "cycle", true);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    source.inputs[i] = quantity(inputs[i].name, inputs[i].si);
    if (inputs[i].value == &OperatingPoint::temperature) source.inputs[i].offset -= celsius_zero;
  }
  source.energy = quantity("energy", "J");
  for (const char* name : {"time", "cycles_per_day"}) {
    const auto at = given.find(name);
    if (at == given.end()) continue;
    if (known.empty())
      throw InputError(
          fmt::format("--columns: '{}' is for wearwell fleet only: the statements report wear and "
                      "life in cycles",
                      name));
    const bool rate = std::string_view(name) == "cycles_per_day";
    fleet::require_column(known, at->second, table, rate);
    (rate ? source.per_day : source.time) = at->second;
  }
  if (!source.time.empty() && !source.per_day.empty())
    throw InputError(
        "--columns: 'time' and 'cycles_per_day' both give the cycles per day of a unit: keep one "
        "of them");
  for (const auto& each : known) {
    if (each.name != source.time) continue;
    source.is_date = each.is_date;
    // Texts, as in CSV, are parsed by the engine, or refused.
    if (each.is_number)
      throw InputError(fmt::format("{}: column '{}' has neither dates nor times", table,
                                   printable(source.time)));
  }
}

}  // namespace wearwell::clutch
