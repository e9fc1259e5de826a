#include "wearwell/models/formula_model/returns_count.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/formula_model/returns_period.h"
#include "wearwell/present/plain.h"

namespace wearwell::formula_model {
namespace {

constexpr int most_periods = 1200;

// Returns by one failure mode, by period.
struct CountedMode {
  std::size_t row = 0;  // the first one
  std::map<int, double> returns = {};
};

struct CountedSales {
  std::size_t row = 0;  // the first one
  double units = 0;
  std::map<std::string, CountedMode> by_mode =
      {};  // one, without a name, if the table has no modes
};

struct UnitColumns {
  std::string sold, returned, quantity = {}, mode = {};
};

// Counts by period of sale and of return, and what lies after the end.
struct UnitCounts {
  std::map<int, CountedSales> sales = {};
  double rows = 0, late_sales = 0, late_returns = 0;
  std::vector<std::string> late_modes = {};
};

// The failure modes of a unit that came back (`returned`), or did not; none if they are not known.
std::vector<std::string> modes_of_unit(const Table& units, const UnitColumns& columns,
                                       const ModeWords& words, std::size_t row, bool returned) {
  if (columns.mode.empty()) return {};
  const std::string text = cell_word(units.column(columns.mode), row);
  if (words.means_unknown(text)) return {};
  if (!returned) {
    if (words.means_runout(text) || censoring_by_word(text) == Censoring::right) return {};
    throw InputError(
        fmt::format("{} is a failure mode, but column '{}' has no return; correct one of them",
                    quoted_place(units, columns.mode, row), columns.returned));
  }
  if (words.means_runout(text))
    throw InputError(
        fmt::format("{} is a run-out, but column '{}' has a return, '{}'; correct one of them",
                    quoted_place(units, columns.mode, row), columns.returned,
                    cell_word(units.column(columns.returned), row)));
  return modes_in(text, [&] { return place(units, columns.mode, row); });
}

Period read_until(const TomlReader& keys) {
  const std::string text = keys.is_integer("until")
                               ? fmt::format("{}", *keys.integer("until", 0, 9999))
                               : keys.required_text("until");
  const auto until = period_in(text);
  if (!until)
    keys.fail("until",
              fmt::format("must be the last period that the table covers: {}", allowed_months));
  return *until;
}

void add_names(std::vector<std::string>& names, const std::vector<std::string>& more) {
  for (const std::string& each : more)
    if (!contains(names, each)) names.push_back(each);
}

// A period of one row, of the kind of `until`.
Period unit_period(const Table& units, const PeriodColumn& column, std::size_t row,
                   const Period& until, std::string& prefix) {
  const auto period = column.at(row);
  if (!period || period->calendar != until.calendar)
    throw InputError(fmt::format(
        "{} is not a {}: use {}", quoted_place(units, column.name(), row),
        until.calendar ? "month or day, as `until` is" : "number of a period, as `until` is",
        allowed_months));
  require_kind(units, column.name(), row, *period, prefix);
  return *period;
}

UnitCounts counts_of(const Table& units, const UnitColumns& columns, const ModeWords& words,
                     const Period& until) {
  UnitCounts counts;
  std::string prefix = until.prefix;
  const PeriodColumn sales_of(units.column(columns.sold)),
      returns_of(units.column(columns.returned));
  for (std::size_t row = 0; row < units.rows; ++row) {
    const double number = columns.quantity.empty() ? 1 : units_in(units, columns.quantity, row, -1);
    const Period sold = unit_period(units, sales_of, row, until, prefix);
    counts.rows += number;
    if (sold.number > until.number) {
      counts.late_sales += number;
      continue;
    }
    CountedSales& sales = counts.sales.try_emplace(sold.number, CountedSales{row}).first->second;
    sales.units += number;
    const bool came_back = !cell_word(units.column(columns.returned), row).empty();
    const std::vector<std::string> modes = modes_of_unit(units, columns, words, row, came_back);
    if (!came_back) continue;
    const Period returned = unit_period(units, returns_of, row, until, prefix);
    if (returned.number < sold.number)
      throw InputError(fmt::format("{}: a return before the sale, '{}'",
                                   quoted_place(units, columns.returned, row),
                                   cell_word(units.column(columns.sold), row)));
    if (returned.number > until.number) {
      counts.late_returns += number;
      add_names(counts.late_modes, modes);
    } else {
      const std::string mode = fmt::format("{}", fmt::join(modes, "|"));
      CountedMode& of = sales.by_mode.try_emplace(mode, CountedMode{row}).first->second;
      of.returns[returned.number] += number;
    }
  }
  return counts;
}

// The triangle as a table: a row for each period of sale, or for each of its failure modes. Its origins are rows of the units.
Table table_of(const UnitCounts& counts, const TriangleColumns& columns, const PeriodNames& names,
               int until) {
  const int first = counts.sales.begin()->first;
  Table table;
  table.columns = {Column{columns.period, false, {}, {}}, Column{columns.quantity, true, {}, {}}};
  for (int period = first; period <= until; ++period)
    table.columns.push_back(Column{names.text(period), true, {}, {}});
  Column modes{columns.mode, false, {}, {}};
  for (const auto& [at, sales] : counts.sales) {
    const std::map<std::string, CountedMode> none = {{"", {sales.row}}};
    for (const auto& [mode, counted] : sales.by_mode.empty() ? none : sales.by_mode) {
      ++table.rows;
      table.origins.push_back(counted.row + 1);
      table.columns[0].text.push_back(names.text(at));
      table.columns[1].numbers.push_back(sales.units);
      modes.text.push_back(mode);
      for (int period = first; period <= until; ++period) {
        const auto found = counted.returns.find(period);
        table.columns[static_cast<std::size_t>(period - first) + 2].numbers.push_back(
            found == counted.returns.end() ? 0 : found->second);
      }
    }
  }
  if (!columns.mode.empty()) table.columns.push_back(std::move(modes));
  return table;
}

}  // namespace

ReturnsTriangle counted_triangle(const TomlReader& keys, const Table& units,
                                 const ModeWords& words) {
  UnitColumns read{column_named(keys, "sold", units, ""),
                   column_named(keys, "returned", units, "")};
  if (read.sold == read.returned)
    keys.fail("returned", fmt::format("is the column of `sold`, '{}'", read.sold));
  if (keys.has("quantity")) read.quantity = column_named(keys, "quantity", units, "");
  if (keys.has("mode")) read.mode = column_named(keys, "mode", units, "");
  if (!read.mode.empty() && (read.mode == read.sold || read.mode == read.returned))
    keys.fail("mode", fmt::format("is the column of a period, '{}'", read.mode));
  const Period until = read_until(keys);
  const UnitCounts counts = counts_of(units, read, words, until);
  const PeriodNames names{until.calendar, until.prefix};
  if (counts.sales.empty())
    throw InputError(fmt::format("{}: no unit was sold until {}, the end of the table (`until`)",
                                 units.source, names.text(until.number)));
  if (until.number - counts.sales.begin()->first >= most_periods)
    throw InputError(fmt::format(
        "{}: {} periods from {}, the first sale, to {}; at most {} are "
        "possible: is a date of sale wrong?",
        units.source, until.number - counts.sales.begin()->first + 1,
        names.text(counts.sales.begin()->first), names.text(until.number), most_periods));
  const TriangleColumns columns = {"sold", "units", read.mode.empty() ? "" : "failure mode"};
  Table table = table_of(counts, columns, names, until.number);
  table.source = units.source;
  table.layout = units.layout;
  table.lines = units.lines;
  ReturnsTriangle triangle = read_triangle(keys, std::move(table), columns, words);
  triangle.mode_column = read.mode;
  add_names(triangle.modes, counts.late_modes);
  triangle.notes.push_back(
      fmt::format("{} units counted by period of sale ('{}') and of return "
                  "('{}') until {}",
                  plain_given(counts.rows), read.sold, read.returned, names.text(until.number)));
  if (counts.late_sales > 0)
    triangle.notes.push_back(fmt::format("left out: {} sold after {}",
                                         plain_given(counts.late_sales), names.text(until.number)));
  if (counts.late_returns > 0)
    triangle.notes.push_back(fmt::format("counted as in use: {} returned after {}",
                                         plain_given(counts.late_returns),
                                         names.text(until.number)));
  return triangle;
}

}  // namespace wearwell::formula_model
