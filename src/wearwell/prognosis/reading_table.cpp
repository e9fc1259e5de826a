#include "wearwell/prognosis/reading_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/heading.h"
#include "wearwell/prognosis/new_data.h"

namespace wearwell::prognosis {
namespace {

// The column of this name, with its unit in the heading or without a unit.
const Column& named_in_table(const Table& table, const std::string& name, const std::string& si) {
  const Column* found = nullptr;
  for (const Column& each : table.columns) {
    if (each.name != name && read_heading(each.name, si).name != name) continue;
    if (found)
      throw InputError(fmt::format("{}: both '{}' and '{}' may be {}", table.source,
                                   printable(found->name), printable(each.name), name));
    found = &each;
  }
  return found ? *found : table.column(name);
}

}  // namespace

NumberColumn number_column(const Table& table, const ReadingColumn& wanted) {
  const Column& column = named_in_table(table, wanted.name, wanted.unit.text);
  const std::string said = read_heading(column.name, wanted.unit.text).unit;
  if (said.empty() && column.unit.empty() && wanted.unit.text != "1")
    throw InputError(fmt::format("{}: the column '{}' needs its unit: '{} [{}]'", table.source,
                                 printable(column.name), wanted.name, wanted.unit.text));
  const std::string text = said.empty() ? column.unit.empty() ? "1" : bare_unit(column.unit) : said;
  try {
    return {&column, read_unit(text, wanted.unit.text)};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}, column '{}': {}", table.source, printable(column.name),
                                 printable(error.what())));
  }
}

std::string unit_name(const Column& units, std::size_t row) {
  return units.is_number ? fmt::format("{}", units.numbers[row]) : units.text[row];
}

ReadingTable::ReadingTable(const Tracker& tracker, const Table& table) : table_(table) {
  for (const ReadingColumn& each : tracker.columns())
    numbers_.push_back(number_column(table, each));
  for (const std::string& each : tracker.labels()) labels_.push_back(&table.column(each));
}

Reading ReadingTable::reading(std::size_t row) const {
  Reading reading;
  for (const NumberColumn& each : numbers_)
    reading.numbers.push_back(to_si(each.unit, cell_number(table_, *each.column, row)));
  for (const Column* each : labels_) reading.labels.push_back(unit_name(*each, row));
  return reading;
}

std::vector<Reading> readings_of_unit(const Tracker& tracker, const std::string& unit,
                                      const Table& table) {
  const ReadingTable rows(tracker, table);
  const auto units = std::find_if(table.columns.begin(), table.columns.end(),
                                  [&](const Column& each) { return each.name == tracker.noun(); });
  std::vector<Reading> readings;
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (units != table.columns.end() && unit_name(*units, row) != unit)
      throw InputError(fmt::format("{}: it is a reading of {} '{}', and '{}' is tracked",
                                   place(table, units->name, row), tracker.noun(),
                                   printable(unit_name(*units, row)), printable(unit)));
    Reading reading = rows.reading(row);
    if (const std::string problem = tracker.problem(reading); !problem.empty())
      throw InputError(
          fmt::format("{}, {}: {}", table.source, row_name(row + 1, 0), printable(problem)));
    readings.push_back(std::move(reading));
  }
  return readings;
}

Table in_study_names(const Table& table, std::span<const ReadingColumn> columns,
                     const Source& source) {
  const Table& data = data_table(source);
  const DataRoles roles = data_roles(TomlReader::parse(source.study), data);
  const auto has = [](const Table& in, const std::string& heading) {
    return std::any_of(in.columns.begin(), in.columns.end(),
                       [&](const Column& each) { return each.name == heading; });
  };
  Table named = table;
  for (Column& column : named.columns) {
    const auto same =
        std::find_if(roles.used.begin(), roles.used.end(),
                     [&](const DataRoles::Named& each) { return each.column == column.name; });
    std::string unit;
    if (same != roles.used.end()) {
      unit = !same->unit.empty() ? same->unit : bare_unit(data.column(same->column).unit);
      if (unit.empty()) unit = read_heading(column.name, "").unit;
      if (same->name != column.name && !has(table, same->name)) column.name = same->name;
    }
    for (const ReadingColumn& each : columns) {
      if (each.name == column.name && column.unit.empty() && each.unit.text != "1")
        column.unit = unit.empty() ? each.unit.text : unit;
    }
  }
  return named;
}

}  // namespace wearwell::prognosis
