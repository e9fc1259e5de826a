#include "wearwell/models/formula_model/returns_count.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/formula_model/failure_modes.h"
#include "wearwell/models/formula_model/returns_period.h"
#include "wearwell/present/plain.h"

namespace wearwell::formula_model {
namespace {

constexpr int most_periods = 1200;

struct CountedSales {
  double units = 0;
  // By failure mode (one, without a name, where the table has no modes), then by period.
  std::map<std::string, std::map<int, double>> returns = {};
};

struct UnitColumns {
  std::string sold, returned, quantity = {}, mode = {};
};

// Counts by period of sale and of return, and what lies after the end.
struct UnitCounts {
  std::map<int, CountedSales> sales = {};
  double rows = 0, late_sales = 0, late_returns = 0;
};

// The failure mode of a unit that came back (`returned`), or did not.
std::string mode_of_unit(const Table& units, const UnitColumns& columns, std::size_t row,
                         bool returned) {
  if (columns.mode.empty()) return "";
  const std::string text = cell_word(units.column(columns.mode), row);
  if (is_missing_mark(text)) return "";
  const bool runout = censoring_by_word(text) == Censoring::right &&
                      folded_word(text).size() >= shortest_runout_word;
  if (returned && runout)
    throw InputError(
        fmt::format("{} is a run-out, but column '{}' has a return, '{}'; correct one of them",
                    quoted_place(units, columns.mode, row), columns.returned,
                    cell_word(units.column(columns.returned), row)));
  if (!returned && !text.empty() && censoring_by_word(text) != Censoring::right &&
      folded_word(text) != "unknown")
    throw InputError(
        fmt::format("{} is a failure mode, but column '{}' has no return; correct one of them",
                    quoted_place(units, columns.mode, row), columns.returned));
  return text;
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

// A period of one row, of the kind of `until`.
Period unit_period(const Table& units, const std::string& column, std::size_t row,
                   const Period& until, std::string& prefix) {
  const auto period = period_in(cell_word(units.column(column), row));
  if (!period || period->calendar != until.calendar)
    throw InputError(fmt::format(
        "{} is not a {}: use {}", quoted_place(units, column, row),
        until.calendar ? "month or day, as `until` is" : "number of a period, as `until` is",
        allowed_months));
  require_kind(units, column, row, *period, prefix);
  return *period;
}

UnitCounts counts_of(const Table& units, const UnitColumns& columns, const Period& until) {
  UnitCounts counts;
  std::string prefix = until.prefix;
  for (std::size_t row = 0; row < units.rows; ++row) {
    const double number = columns.quantity.empty() ? 1 : units_in(units, columns.quantity, row, -1);
    const Period sold = unit_period(units, columns.sold, row, until, prefix);
    counts.rows += number;
    if (sold.number > until.number) {
      counts.late_sales += number;
      continue;
    }
    CountedSales& sales = counts.sales[sold.number];
    sales.units += number;
    const bool came_back = !cell_word(units.column(columns.returned), row).empty();
    const std::string mode = mode_of_unit(units, columns, row, came_back);
    if (!came_back) continue;
    const Period returned = unit_period(units, columns.returned, row, until, prefix);
    if (returned.number < sold.number)
      throw InputError(fmt::format("{}: a return before the sale, '{}'",
                                   quoted_place(units, columns.returned, row),
                                   cell_word(units.column(columns.sold), row)));
    if (returned.number > until.number) {
      counts.late_returns += number;
    } else {
      sales.returns[mode][returned.number] += number;
    }
  }
  return counts;
}

// The triangle as a table: a row for each period of sale, or for each of its failure modes.
Table table_of(const UnitCounts& counts, const TriangleColumns& columns, const PeriodNames& names,
               int until) {
  const int first = counts.sales.begin()->first;
  const std::map<std::string, std::map<int, double>> none = {{"", {}}};
  Table table;
  table.columns = {Column{columns.period, false, {}, {}}, Column{columns.quantity, true, {}, {}}};
  for (int period = first; period <= until; ++period)
    table.columns.push_back(Column{names.text(period), true, {}, {}});
  Column modes{columns.mode, false, {}, {}};
  for (const auto& [at, sales] : counts.sales) {
    for (const auto& [mode, returns] : sales.returns.empty() ? none : sales.returns) {
      ++table.rows;
      table.columns[0].text.push_back(names.text(at));
      table.columns[1].numbers.push_back(sales.units);
      modes.text.push_back(mode);
      for (int period = first; period <= until; ++period) {
        const auto found = returns.find(period);
        table.columns[static_cast<std::size_t>(period - first) + 2].numbers.push_back(
            found == returns.end() ? 0 : found->second);
      }
    }
  }
  if (!columns.mode.empty()) table.columns.push_back(std::move(modes));
  return table;
}

}  // namespace

ReturnsTriangle counted_triangle(const TomlReader& keys, const Table& units) {
  UnitColumns read{column_named(keys, "sold", units, ""),
                   column_named(keys, "returned", units, "")};
  if (read.sold == read.returned)
    keys.fail("returned", fmt::format("is the column of `sold`, '{}'", read.sold));
  if (keys.has("quantity")) read.quantity = column_named(keys, "quantity", units, "");
  if (keys.has("mode")) read.mode = column_named(keys, "mode", units, "");
  if (!read.mode.empty() && (read.mode == read.sold || read.mode == read.returned))
    keys.fail("mode", fmt::format("is the column of a period, '{}'", read.mode));
  const Period until = read_until(keys);
  const UnitCounts counts = counts_of(units, read, until);
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
  ReturnsTriangle triangle = read_triangle(keys, std::move(table), columns);
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
