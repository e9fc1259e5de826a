#include "wearwell/models/recurrence/recurrence_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/recurrence/event_words.h"
#include "wearwell/models/recurrence/grouped_counts.h"

namespace wearwell::recurrence {
namespace {

constexpr const char* last_failure = "last failure";

// An age is a time, a distance, a number of cycles or revolutions, or an energy.
ColumnChoice read_age(const TomlReader& columns, const Table& table, std::string& si) {
  std::optional<InputError> first;
  for (const char* candidate : {"s", "m", "cycle", "rev", "J"}) {
    try {
      const ColumnChoice age = required_column(columns, "age", candidate, table);
      if (age.unit.text == "1" || age.unit.text.empty()) continue;  // a count that names no unit
      si = candidate;
      return age;
    } catch (const InputError& error) {
      if (!first) first = error;
    }
  }
  const std::string message = first->what();
  if (message.find("wrong dimension") == message.npos) throw *first;
  throw InputError(
      message + "; an age is a time, a distance, a number of cycles or revolutions, or an energy");
}

// The state of reading a unit's rows.
struct Reading {
  std::size_t unit = 0;
  double last = 0;
  std::size_t last_row = 0;
  bool begun = false, ended = false;
  std::size_t end_gap = 0;  // once it has ended
};

std::size_t row_of_file(const Table& table, std::size_t row) {
  return table.origins.empty() ? row + 1 : table.origins[row];
}

void check_age(const Table& table, const ColumnChoice& age, double value, const Reading& unit,
               const UnitHistory& history, std::size_t row) {
  const std::string cell = cell_word(table.column(age.column), row);
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {} {}", place(table, age.column, row), cell, why));
  };
  if (!(value >= 0)) refuse("must be 0 or more");
  if (unit.ended)
    refuse(fmt::format("follows the end of observation of unit '{}' in row {}", history.name,
                       row_of_file(table, unit.last_row)));
  if (unit.begun && value < unit.last)
    refuse(fmt::format(
        "is less than {}, the age of unit '{}' in row {}: ages of a unit must not go back",
        cell_word(table.column(age.column), unit.last_row), history.name,
        row_of_file(table, unit.last_row)));
  if (value < history.start)
    refuse(fmt::format("lies before the start of observation of unit '{}'", history.name));
}

void check_failure(const Table& table, const ColumnChoice& age, const Gap& gap, double rounding,
                   const UnitHistory& history, std::size_t row) {
  const std::string where = place(table, age.column, row),
                    cell = cell_word(table.column(age.column), row);
  if (gap.to == 0)
    throw InputError(
        fmt::format("{}: a failure at age 0; the age of a failure must be positive", where));
  if (gap.to > gap.from) return;
  if (gap.first)
    throw InputError(fmt::format("{}: unit '{}' fails at the very start of its observation, {}",
                                 where, history.name, cell));
  if (rounding > 0) return;
  throw InputError(
      fmt::format("{}: unit '{}' fails again at {}: either the row is a copy, then remove it; or "
                  "several failures fell into one "
                  "rounded age, then state the rounding, for example data.rounding = \"1 {}\"",
                  where, history.name, cell, age.unit.text));
}

// The order of a failure and the end of observation at one age does not matter: the failure came first.
void add_failure_at_end(const Table& table, const ColumnChoice& age, const Reading& state,
                        std::size_t row, RecurrenceData& data) {
  Gap& end = data.gaps[state.end_gap];
  const Gap failure{state.unit, end.from, end.to, true, end.first};
  UnitHistory& unit = data.units[state.unit];
  check_failure(table, age, failure, data.rounding, unit, row);
  unit.failures.push_back(end.to);
  end.from = end.to;
  end.first = false;
  data.gaps.push_back(failure);
}

// The failures of a unit since its row before, which lie anywhere within the interval.
void add_interval(const Table& table, const ColumnChoice& age, double until, std::size_t count,
                  std::size_t row, Reading& state, RecurrenceData& data) {
  UnitHistory& unit = data.units[state.unit];
  Gap gap{state.unit, state.begun ? state.last : unit.start, until, false, !state.begun, count};
  if (!(gap.to > gap.from) && (count > 0 || gap.first))
    throw InputError(fmt::format(
        "{}: {} failures of unit '{}' in an interval without length, which begins at {} and ends "
        "there; a row counts the failures since the row before",
        place(table, age.column, row), count, unit.name,
        state.begun ? cell_word(table.column(age.column), state.last_row)
                    : std::string("the start of its observation")));
  unit.failures.insert(unit.failures.end(), count, until);
  unit.end = until;
  unit.grouped = true;
  data.gaps.push_back(gap);
  state.last = until;
  state.last_row = row;
  state.begun = true;
}

// A column of counts that no key reads would count each row once.
void refuse_idle_counts(const TomlReader& section, const Table& table) {
  const std::vector<std::string> unused = section.texts("unused");
  for (const Column& column : table.columns) {
    if (!column.is_number || folded_word(column.name) != "count" || contains(unused, column.name))
      continue;
    for (std::size_t row = 0; row < table.rows; ++row) {
      if (!(column.numbers[row] > 1)) continue;
      throw InputError(fmt::format(
          "{}: {:.10g} can be the number of failures of the unit at that age, then write count = "
          "\"{}\" in [data.columns]; or something else, then write unused = [\"{}\"] in [data]",
          place(table, column.name, row), column.numbers[row], column.name, column.name));
    }
  }
}

// A row for each failure of a row that counts several at one age. An end of observation is one row: its count is
// 1, 0 or empty.
Table each_failure(const TomlReader& section, const EventWords& words, Table table) {
  const TomlReader columns = section.required_table("columns");
  if (!columns.has("count")) {
    refuse_idle_counts(section, table);
    return table;
  }
  const std::string heading =
      study_column(columns, "count",
                   columns.is_text("count")
                       ? columns.required_text("count")
                       : columns.required_table("count").required_text("column"),
                   table)
          .name;
  for (Column& column : table.columns) {
    if (column.name != heading) continue;
    for (std::size_t row = 0; row < table.rows; ++row) {
      if (read_event(table, words, row)) continue;
      const std::string cell = cell_word(column, row);
      if (!cell.empty() && cell != "0" && cell != "1")
        throw InputError(
            fmt::format("{}: {} ends of observation of one unit; an end is one row, with a count "
                        "of 1, 0 or none",
                        place(table, heading, row), cell));
      if (column.is_number)
        column.numbers[row] = 1;
      else
        column.text[row] = "1";
    }
  }
  return with_counts(columns, std::move(table));
}

// The mode of a failure. An end of observation has none: a word there can be a failure that is not counted.
void read_mode(const Table& table, const std::optional<ColumnChoice>& mode, std::size_t row,
               bool failed, UnitHistory& unit) {
  if (!mode) return;
  const Column& column = table.column(mode->column);
  if (failed) {
    unit.modes.push_back(label_word(table, column, row));
  } else if (const std::string word = cell_word(column, row); !word.empty()) {
    throw InputError(
        fmt::format("{}: '{}' is a failure mode in the row of an end of observation; leave the "
                    "cell empty, or, if the unit failed then, write failure as the event",
                    place(table, mode->column, row), word));
  }
}

std::vector<double> read_starts(const TomlReader& columns, const Table& table,
                                const std::string& si, std::optional<ColumnChoice>& start) {
  start = read_column(columns, "start", si, table);
  std::vector<double> starts(table.rows);
  if (!start) return starts;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const double value = cell_number(table, table.column(start->column), i);
    starts[i] = to_si(start->unit, value);
    require(starts[i] >= 0, table, *start, i, "0 or more; 0 if it was observed from age 0");
  }
  return starts;
}

void close_units(const TomlReader& section, const Table& table, const std::string& unit_column,
                 const std::map<std::string, Reading>& read, RecurrenceData& data) {
  const bool at_failure = section.choice("end", {"row", last_failure}) == last_failure;
  for (const auto& [name, state] : read) {
    UnitHistory& unit = data.units[state.unit];
    if (state.ended) continue;
    if (!at_failure)
      throw InputError(
          fmt::format("{}: unit '{}' has no row of its end of observation; add one with its age "
                      "now and the event end, or, if each "
                      "unit was observed until its last failure and not longer, state data.end = "
                      "\"last failure\"",
                      place(table, unit_column, state.last_row), name));
    unit.end = state.last;
    unit.ends_at_failure = true;
  }
}

}  // namespace

std::size_t RecurrenceData::failures() const {
  std::size_t sum = 0;
  for (const UnitHistory& unit : units) sum += unit.failures.size();
  return sum;
}

double RecurrenceData::first_start() const {
  double least = units.front().start;
  for (const UnitHistory& unit : units) least = std::min(least, unit.start);
  return least;
}

double RecurrenceData::longest() const {
  double most = 0;
  for (const UnitHistory& unit : units) most = std::max(most, unit.end);
  return most;
}

RecurrenceData read_recurrence_data(const TomlReader& root, const Source& source) {
  const TomlReader section = root.required_table("data");
  const TomlReader columns = section.required_table("columns");
  const Table written = read_table(section, source);
  const bool grouped = is_grouped(section);
  std::optional<EventWords> words;
  if (!grouped || columns.has("event")) words = read_event_words(columns, written);
  const Table table = grouped ? written : each_failure(section, *words, written);
  const std::vector<std::size_t> counts =
      grouped ? read_counts(columns, table, words) : std::vector<std::size_t>();
  RecurrenceData data;
  const auto unit_column = read_word_column(columns, "unit", table);
  if (!unit_column)
    columns.fail("unit", "is missing: the column that names the unit of each event");
  const ColumnChoice age = read_age(columns, table, data.si);
  const auto mode = read_word_column(columns, "mode", table);
  if (mode && grouped)
    columns.fail("mode", "needs the age of each failure, not a number by interval (data.grouped)");
  std::optional<ColumnChoice> start;
  const std::vector<double> starts = read_starts(columns, table, data.si, start);
  if (const auto rounding = section.quantity("rounding", data.si)) {
    if (!(rounding->si() > 0)) section.fail("rounding", "must be positive");
    data.rounding = rounding->si();
  }
  const std::vector<double> ages = si_numbers(table, age);
  data.unit = age.unit;
  std::map<std::string, Reading> read;
  for (std::size_t i = 0; i < table.rows; ++i) {
    check_stop();
    const std::string name = label_word(table, table.column(unit_column->column), i);
    const auto [at, is_new] = read.try_emplace(name, Reading{data.units.size()});
    if (is_new) data.units.push_back({name, starts[i]});
    Reading& state = at->second;
    UnitHistory& unit = data.units[state.unit];
    if (starts[i] != unit.start)
      throw InputError(fmt::format("{}: the start of unit '{}' differs from that in its first row",
                                   place(table, start->column, i), name));
    const bool failed = words && read_event(table, *words, i);
    if (grouped) {
      check_age(table, age, ages[i], state, unit, i);
      add_interval(table, age, ages[i], counts[i], i, state, data);
      state.ended = words && !failed;
      continue;
    }
    read_mode(table, mode, i, failed, unit);
    if (failed && state.ended && ages[i] == state.last) {
      add_failure_at_end(table, age, state, i, data);
      continue;
    }
    check_age(table, age, ages[i], state, unit, i);
    const Gap gap{state.unit, state.begun ? state.last : unit.start, ages[i], failed, !state.begun};
    if (failed) {
      check_failure(table, age, gap, data.rounding, unit, i);
      unit.failures.push_back(ages[i]);
    } else if (gap.first && !(ages[i] > unit.start)) {
      throw InputError(fmt::format("{}: the observation of unit '{}' ends where it starts",
                                   place(table, age.column, i), name));
    } else {
      unit.end = ages[i];
    }
    data.gaps.push_back(gap);
    state = {state.unit, ages[i], i, true, !failed, data.gaps.size() - 1};
  }
  if (!grouped) close_units(section, table, unit_column->column, read, data);
  data.columns.push_back({"age", data.si, age.unit, ages});
  data.layout = table.layout;
  return data;
}

}  // namespace wearwell::recurrence
