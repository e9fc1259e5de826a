#include "wearwell/models/recurrence/recurrence_scaffold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "wearwell/input/columns.h"
#include "wearwell/input/life_status.h"
#include "wearwell/input/toml_text.h"
#include "wearwell/models/recurrence/event_words.h"
#include "wearwell/study/column_values.h"

namespace wearwell::recurrence {
namespace {

using Found = ColumnRoles::Found;

// A column that names units: by its heading, or one word in all rows, as of a prototype.
const Column* unit_column(const ColumnRoles& roles) {
  if (const auto unit = roles.find({"unit"}); unit && repeats(roles.table(), *unit->column))
    return unit->column;
  const auto group = roles.find({"label"}), status = roles.find({"status"});
  for (const Column& each : roles.table().columns) {
    const bool other = (group && group->column == &each) || (status && status->column == &each);
    if (!each.is_number && !other && kinds_of(roles.table(), each).size() == 1) return &each;
  }
  return nullptr;
}

struct Histories {
  std::size_t units = 0, ended = 0, failures = 0, most_rows = 0;
  bool ends_come_last = true;
  bool rises = true;     // in the order of the table
  bool several = false;  // failures of a unit at one age
};

struct History {
  std::size_t rows = 0;
  bool fails = false;
  double last = 0, last_failure = 0, end = std::numeric_limits<double>::infinity();
};

// Empty if a cell is neither a failure nor an end.
std::optional<Histories> histories_of(const Table& table, const Column& unit, const Column& age,
                                      const Column& event, std::optional<int> failure_code,
                                      const Column* count) {
  const std::vector<double> counts =
      count ? numbers_of(table, *count) : std::vector<double>(table.rows, 1);
  std::map<std::string, History> of_unit;
  Histories all;
  const std::vector<double> ages = numbers_of(table, age);
  for (std::size_t row = 0; row < table.rows; ++row) {
    const auto failed = is_failure_word(cell_word(event, row), failure_code);
    if (!failed || !(ages[row] >= 0)) return {};
    History& history = of_unit[cell_word(unit, row)];
    if (history.rows++ > 0 && !(ages[row] >= history.last)) all.rises = false;
    history.last = ages[row];
    all.most_rows = std::max(all.most_rows, history.rows);
    if (*failed) {
      if (!(counts[row] >= 1)) return {};
      all.several |= counts[row] > 1 || (history.fails && history.last_failure == ages[row]);
      history.fails = true;
      history.last_failure = std::max(history.last_failure, ages[row]);
      all.failures += static_cast<std::size_t>(counts[row]);
    } else {
      all.ends_come_last &= history.end == std::numeric_limits<double>::infinity();
      history.end = ages[row];
      ++all.ended;
    }
  }
  for (const auto& [name, history] : of_unit)
    all.ends_come_last &= history.last_failure <= history.end;
  all.units = of_unit.size();
  return all;
}

// The step to which ages are written: several failures of a unit fell into one.
std::string rounding_line(const Table& table, const Found& age) {
  double step = 1;
  for (const double least = 1e-6; step > least; step /= 10) {
    const std::vector<double> ages = numbers_of(table, *age.column);
    if (std::all_of(ages.begin(), ages.end(), [&](double each) {
          return std::abs(each / step - std::round(each / step)) < 1e-6;
        }))
      break;
  }
  if (age.unit == "1" || std::isdigit(static_cast<unsigned char>(age.unit.front()))) return "";
  return fmt::format(
      "rounding = {}    # GUESS: the step of the ages; a unit has several failures at one age\n",
      toml_text(fmt::format("{:.6g} {}", step, age.unit)));
}

}  // namespace

std::optional<Scaffold> scaffold(ColumnRoles& roles) {
  const auto event = roles.find({"status"});
  const auto age = roles.find({"life", "time", "distance", "cycles", "revolutions"});
  const Column* unit = unit_column(roles);
  if (!event || !age || !unit || unit == event->column || unit == age->column) return {};
  if (roles.has({"depth", "volume", "mass", "crack", "mode", "entry"})) return {};
  std::optional<int> code = roles.choices().failure;
  if (!code) code = failure_code_of(event->column->name);
  const auto count = roles.find({"count"});
  const auto all = histories_of(roles.table(), *unit, *age->column, *event->column, code,
                                count ? count->column : nullptr);
  // Rows in rising order can be lives in sorted order; with an end of each unit they are not.
  if (!all || all->most_rows < 2 || all->failures == 0 || !all->ends_come_last) return {};
  const bool each_ends = all->ended == all->units;
  if (!each_ends && !all->rises) return {};
  const Found taken = *roles.take("age", {"life", "time", "distance", "cycles", "revolutions"});
  roles.take_column("unit", *unit, role_form("unit"));
  roles.take_column("event", *event->column, role_form("status"));
  const std::string counts =
      count ? ColumnRoles::line("count", *roles.take("count", {"count"})) : "";
  const std::string rounding = all->several ? rounding_line(roles.table(), taken) : "";
  const std::string heading = toml_text(event->column->name);
  const std::string end =
      all->ended > 0 ? "" : "end = \"last failure\"    # GUESS: no row is an end of observation\n";
  if (all->ended == 0)
    roles.guesses.emplace_back(
        "no row is an end of observation: each unit is taken to be observed until its last failure "
        "(end = \"last failure\" in [data])");
  return roles.study(
      "failures of repaired units along their age",
      each_ends ? ReadingFit::specific : ReadingFit::general,
      fmt::format("title = {}\n"
                  "model = \"repairable\"\n"
                  "process = \"power_law\"    # minimal repair, as bad as old; or \"renewal\", as "
                  "good as new\n\n"
                  "{}{}{}[data.columns]\n"
                  "unit = {}\n{}event = {}    # failure, or end of observation\n{}\n"
                  "# Prior knowledge: PROPOSED as weak priors. Replace them with what you know of "
                  "such units.\n"
                  "[prior]\n"
                  "beta = {{ distribution = \"lognormal\", median = 1, log_sd = 0.7 }}    # above "
                  "1, failures "
                  "become more frequent with age\n"
                  "M_T = {{ distribution = \"lognormal\", median = {:.3g}, log_sd = 3 }}    # "
                  "failures of one "
                  "unit until the largest age\n",
                  toml_text("Failures of repaired units, from " + roles.file()),
                  roles.data_section(), end, rounding, toml_text(unit->name),
                  ColumnRoles::line("age", taken),
                  code ? fmt::format("{{ column = {}, failure = {} }}", heading, *code) : heading,
                  counts, static_cast<double>(all->failures) / static_cast<double>(all->units)));
}

}  // namespace wearwell::recurrence
