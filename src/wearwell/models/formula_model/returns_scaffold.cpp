#include "wearwell/models/formula_model/returns_scaffold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/date_text.h"
#include "wearwell/input/month_text.h"
#include "wearwell/input/prior.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/formula_model/returns_period.h"
#include "wearwell/models/formula_model/returns_triangle.h"
#include "wearwell/study/role_words.h"

namespace wearwell::formula_model {
namespace {

// What the prefix of numbered periods says of their length: "KW" are weeks.
std::string period_of_prefix(const std::string& prefix) {
  const std::string word = folded_word(prefix);
  for (const char* each : {"w", "kw", "week", "woche", "semaine"})
    if (word == each) return "week";
  for (const char* each : {"m", "month", "monat", "mois", "mes"})
    if (word == each) return "month";
  return "";
}

// The end of a triangle, as a number of periods.
double length_of(const Table& table) {
  constexpr std::size_t others = 2;
  return std::max<double>(1, static_cast<double>(table.columns.size() - others));
}

// The life of units, and what is asked of it, for a table that covers so many periods.
std::string life_text(double periods, const std::string& unit) {
  return fmt::format(
      "# warranty = \"36 {}\"                  # in use; later failures are not claimed\n\n"
      "[likelihood.life]\nfamily = \"weibull\"                       # or lognormal, loglogistic, "
      "gamma (docs/reference/formula-models.md)\n"
      "scale  = \"characteristic\"                # 63.2 % have failed by then\nshape  = "
      "\"slope\"\n\n"
      "# Prior knowledge: PROPOSED as weak priors from the length of the table. Replace them with "
      "what you know.\n[prior]\n"
      "characteristic = {{ distribution = \"lognormal\", median = \"{} {}\", log_sd = 2 }}    # a "
      "factor of 27 to either side\n"
      "slope = {{ distribution = \"lognormal\", median = 1.2, log_sd = 0.5 }}    # below 1: early "
      "failures, above: wear-out\n\n"
      "[predict]\nnext = \"12 {}\"                        # returns to come\n"
      "# cost_per_return = \"180 EUR\"\n"
      "# planned_sales = {{ file = \"planned_sales.csv\" }}    # columns: period of sale, units\n",
      unit, rounded_up(10 * periods), unit, unit);
}

// "July": a month, but of no year.
bool is_month_without_year(const std::string& text) {
  const auto with_year = period_in(text + " 2024");
  return !period_in(text) && with_year && with_year->calendar;
}

// A triangle by names of months has no order without their years.
void refuse_months_without_year(const Table& table) {
  const Column* months = nullptr;
  std::vector<std::string> headings;
  for (const Column& each : table.columns) {
    if (is_month_without_year(each.name)) headings.push_back(each.name);
    if (each.is_number || months) continue;
    bool all = table.rows > 0;
    for (std::size_t row = 0; all && row < table.rows; ++row)
      all = is_month_without_year(cell_word(each, row));
    if (all) months = &each;
  }
  if (!months || headings.size() < 2) return;
  throw InputError(fmt::format(
      "{}: '{}' and the headings '{}' to '{}' are months without a year; a returns triangle needs "
      "it: write '{} 2024' or 2024-07, in the cells and in the headings",
      table.source, months->name, headings.front(), headings.back(), headings.front()));
}

// Dates of one column: how many cells have one, the first and the last month, and cells that hold anything else.
struct Dates {
  std::size_t cells = 0, others = 0;
  int first = 0, last = 0;
  std::size_t other_row = 0;  // the first of the others
  std::optional<std::size_t> empty_row = {};
};

// Empty unless more cells hold dates than anything else.
std::optional<Dates> dates_in(const Table& table, const Column& column) {
  Dates dates;
  const PeriodColumn periods(column);
  for (std::size_t row = 0; row < table.rows; ++row) {
    const std::string cell = cell_word(column, row);
    if (cell.empty()) {
      if (!dates.empty_row) dates.empty_row = row;
      continue;
    }
    const auto period = periods.at(row);
    if (!period || !period->calendar) {
      if (dates.others++ == 0) dates.other_row = row;
      continue;
    }
    dates.first = dates.cells == 0 ? period->number : std::min(dates.first, period->number);
    dates.last = dates.cells == 0 ? period->number : std::max(dates.last, period->number);
    ++dates.cells;
  }
  if (dates.cells <= dates.others) return {};
  return dates;
}

bool has_any(const std::string& heading, const std::vector<std::string_view>& words) {
  const std::string folded = folded_word(heading);
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return folded.find(word) != std::string::npos; });
}

void require_dates(const Table& table, const Column& column, const Dates& dates, bool of_sale) {
  if (dates.others > 0)
    throw InputError(
        fmt::format("{}: '{}' is not a date; use 2024-01-31, 01/2024 or Jan-24{}",
                    place(table, column.name, dates.other_row), cell_word(column, dates.other_row),
                    of_sale ? "" : ", and leave the cell of a unit that did not come back empty"));
  if (of_sale && dates.empty_row)
    throw InputError(fmt::format("{}: no date of sale; each row is a unit that was sold",
                                 place(table, column.name, *dates.empty_row)));
}

// Day and month can be exchanged in all cells of the column.
void refuse_two_readings(const Table& table, const Column& column) {
  const std::vector<std::string> layouts = date_layouts(column);
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (!date_in(cell_word(column, row), layouts.front())) continue;
    throw InputError(fmt::format(
        "{} can be read as {} or {}, and no cell of the column tells which: write "
        "2024-01-31, or state the layout with a query (data.sql, strptime)",
        quoted_place(table, column.name, row), layout_words(layouts[0]), layout_words(layouts[1])));
  }
}

// One row for each unit: a date of sale, and a date of return that is empty for units still in use.
std::optional<Scaffold> first_units_study(ColumnRoles& roles) {
  const Table& table = roles.table();
  const Column *sold = nullptr, *returned = nullptr, *doubtful = nullptr;
  Dates sales, returns;
  std::vector<std::string> unread;
  for (const Column& each : table.columns) {
    const bool may_be_sale = !sold && has_any(each.name, sale_words()),
               may_be_return = !returned && has_any(each.name, return_words());
    const auto dates = may_be_sale || may_be_return ? dates_in(table, each) : std::nullopt;
    if (dates && may_be_sale) {
      sold = &each;
      sales = *dates;
    } else if (dates && may_be_return) {
      returned = &each;
      returns = *dates;
    } else if ((may_be_sale || may_be_return) && date_layouts(each).size() > 1) {
      (may_be_sale ? sold : returned) = doubtful = &each;
    } else {
      unread.push_back(each.name);
    }
  }
  if (!sold || !returned) return {};
  if (doubtful) refuse_two_readings(table, *doubtful);
  require_dates(table, *sold, sales, true);
  require_dates(table, *returned, returns, false);
  const int last = std::max(sales.last, returns.last);
  const std::string until = month_text(last);
  Scaffold study;
  study.reading = "units with their dates of sale and of return, counted by month";
  study.fit = roles.choices().columns.empty() ? ReadingFit::specific : ReadingFit::none;
  study.taken = {fmt::format("sold: column '{}'", sold->name),
                 fmt::format("returned: column '{}', empty for a unit that did not come back",
                             returned->name)};
  study.guesses = {
      fmt::format("until {}, the last date of the table: state the last month that it covers if "
                  "that is later",
                  until)};
  for (const std::string& each : unread)
    study.guesses.push_back(fmt::format("column '{}' is not used", each));
  study.text = fmt::format(
      "title = {}\nmodel = \"formula\"\n\n{}"
      "[data.returns]                           # a row is a unit; counted by month\n"
      "sold     = {}\nreturned = {}\n"
      "until    = {}                     # the last date of the table; later months without a date "
      "count, too\n{}",
      toml_text("Returns, from " + roles.file()), roles.data_section(), toml_text(sold->name),
      toml_text(returned->name), toml_text(until), life_text(last - sales.first + 1, "month"));
  return study;
}

}  // namespace

std::optional<Scaffold> first_returns_study(ColumnRoles& roles) {
  const Table& table = roles.table();
  const auto columns = triangle_columns(table);
  if (!columns) {
    refuse_months_without_year(table);
    return first_units_study(roles);
  }
  Scaffold study;
  study.reading = "returns triangle (Nevada table): units sold and their returns by period";
  study.fit = ReadingFit::specific;
  if (!roles.choices().columns.empty()) study.fit = ReadingFit::none;
  study.taken = {
      fmt::format("sold: column '{}'", columns->period),
      fmt::format("quantity: column '{}'", columns->quantity),
      fmt::format("periods of return: columns '{}' to '{}'", columns->first, columns->last)};
  study.guesses = {"a unit starts in the middle of its period of sale; an empty cell is no return"};
  for (const std::string& each : columns->unread)
    study.guesses.push_back(fmt::format("column '{}' is not used", each));
  std::string unit = "month", line;
  if (!columns->calendar) {
    unit = period_of_prefix(columns->prefix);
    line = unit.empty() ? roles.unstated_line("period", "the length of a period", "month")
                        : fmt::format("period   = {}\n", toml_text(unit));
    if (unit.empty()) unit = "month";
  }
  study.unstated = roles.unstated;
  study.text = fmt::format(
      "title = {}\nmodel = \"formula\"\n\n{}"
      "[data.returns]                           # a row is a period of sale, a column a period of "
      "return\nsold     = {}\nquantity = {}\n{}"
      "ages     = \"middle\"                      # of the period of sale; or start, end, whole "
      "(docs/reference/warranty.md)\n"
      "{}",
      toml_text("Returns, from " + roles.file()), roles.data_section(), toml_text(columns->period),
      toml_text(columns->quantity), line, life_text(length_of(table), unit));
  return study;
}

}  // namespace wearwell::formula_model
