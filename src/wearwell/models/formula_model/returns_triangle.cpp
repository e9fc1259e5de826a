#include "wearwell/models/formula_model/returns_triangle.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/month_text.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/formula_model/returns_period.h"

// Longer than others: one table, with all that is wrong with its headings, rows and cells.
namespace wearwell::formula_model {
namespace {

struct Heading {
  const Column* column;
  Period period;
};

std::vector<Heading> period_headings(const Table& table, const std::vector<std::string>& without) {
  std::vector<Heading> found;
  for (const Column& each : table.columns) {
    if (contains(without, each.name)) continue;
    if (const auto period = period_in(each.name)) found.push_back({&each, *period});
  }
  return found;
}

std::vector<Heading> in_order(std::vector<Heading> headings) {
  std::stable_sort(headings.begin(), headings.end(), [](const Heading& a, const Heading& b) {
    return a.period.number < b.period.number;
  });
  return headings;
}

// The only column of numbers, or the only one whose heading says units sold.
const Column* quantity_among(const std::vector<const Column*>& columns) {
  if (columns.size() == 1) return columns.front();
  const Column* found = nullptr;
  for (const Column* each : columns) {
    const std::string heading = folded_word(each->name);
    bool named = false;
    for (const char* word :
         {"sold",   "ship",   "quantity", "qty",      "units",  "sales",     "menge",
          "anzahl", "stuck",  "stueck",   "verkauf",  "absatz", "geliefert", "quantite",
          "vendu",  "ventes", "livr",     "cantidad", "vendid", "unidades"})
      named = named || heading.find(word) != heading.npos;
    if (!named) continue;
    if (found) return nullptr;
    found = each;
  }
  return found;
}

// Headings in the order of time, one for each period.
std::vector<Heading> ordered_headings(const TomlReader& keys, const Table& table,
                                      const TriangleColumns& columns) {
  std::vector<Heading> headings =
      period_headings(table, {columns.period, columns.quantity, columns.mode});
  if (headings.empty())
    keys.fail("", fmt::format("{} has no column of a period of return: a heading is {}",
                              table.source, allowed_months));
  for (const Heading& each : headings) {
    if (!each.period.is_like(headings.front().period))
      throw InputError(fmt::format("{}: columns '{}' and '{}' are periods of different kinds",
                                   table.source, headings.front().column->name, each.column->name));
  }
  return in_order(std::move(headings));
}

void require_consecutive(const Table& table, const std::vector<Heading>& headings,
                         const PeriodNames& names) {
  for (std::size_t i = 1; i < headings.size(); ++i) {
    const int before = headings[i - 1].period.number, now = headings[i].period.number;
    if (now == before)
      throw InputError(fmt::format("{}: columns '{}' and '{}' are the same period", table.source,
                                   headings[i - 1].column->name, headings[i].column->name));
    if (now != before + 1)
      throw InputError(fmt::format(
          "{}: no column of {} between '{}' and '{}'; add it, with 0 if nothing came back",
          table.source, names.text(before + 1), headings[i - 1].column->name,
          headings[i].column->name));
  }
}

// A last column without any entry: nothing came back, or it is not over yet.
void require_last_column(const Table& table, const Heading& last) {
  for (std::size_t row = 0; row < table.rows; ++row)
    if (!cell_word(*last.column, row).empty()) return;
  throw InputError(
      fmt::format("{}: column '{}' is empty: either nothing came back, then write 0; or it is "
                  "still to come, then remove the column",
                  table.source, last.column->name));
}

Period period_of_sale(const Table& table, const PeriodColumn& column, std::size_t row,
                      const Heading& like) {
  const Period sale = required_period(table, column, row);
  if (sale.is_like(like.period) || (!sale.calendar && !like.period.calendar)) return sale;
  if (sale.calendar)
    throw InputError(fmt::format(
        "{} is a month, but the column '{}' a number: write months of return as headings. If the "
        "columns are months in service (0, 1, 2 ...), shift each row to the month of return",
        quoted_place(table, column.name(), row), like.column->name));
  throw InputError(fmt::format("{} is a number, but the column '{}' a month",
                               quoted_place(table, column.name(), row), like.column->name));
}

// Adds the returns of a row to those of its period of sale; those of the row alone.
std::vector<int> read_returns(const Table& table, const std::string& quantity_column,
                              const std::vector<Heading>& headings, std::size_t row,
                              SalesPeriod& sale) {
  int left = sale.sold - std::accumulate(sale.returns.begin(), sale.returns.end(), 0);
  const int first = headings.front().period.number, last = headings.back().period.number;
  sale.returns.resize(static_cast<std::size_t>(std::max(0, last - sale.at + 1)));
  std::vector<int> own(sale.returns.size());
  for (const Heading& each : headings) {
    const int count = units_in(table, each.column->name, row, 0);
    const int after = each.period.number - sale.at;
    if (after < 0) {
      if (count == 0) continue;
      throw InputError(fmt::format(
          "{}: a return before the sale; rows are periods of sale, columns periods of return (not "
          "periods in service)",
          quoted_place(table, each.column->name, row)));
    }
    left -= count;
    if (left < 0)
      throw InputError(fmt::format("{}: with this, {} of the {} units sold ('{}') have come back",
                                   quoted_place(table, each.column->name, row), sale.sold - left,
                                   sale.sold, quantity_column));
    sale.returns[static_cast<std::size_t>(after)] += count;
    own[static_cast<std::size_t>(after)] = count;
  }
  if (sale.at < first - 1)
    throw InputError(fmt::format(
        "{}: sold before '{}', the first column of returns: returns between are missing; add their "
        "columns, with 0 if nothing came back",
        place(table, quantity_column, row), headings.front().column->name));
  return own;
}

// The failure modes of a row; none if they are not known. A run-out is no mode of a return (`any`).
std::vector<std::string> modes_of_row(const Table& table, const std::string& column,
                                      std::size_t row, const ModeWords& words, bool any) {
  const std::string text = cell_word(table.column(column), row);
  if (words.means_unknown(text)) return {};
  if (!words.means_runout(text)) return modes_in(text, [&] { return place(table, column, row); });
  if (!any) return {};
  throw InputError(
      fmt::format("{} is a run-out, but the row has returns: units that did not come back have no "
                  "row of a mode; if it is a failure mode, give it another name",
                  quoted_place(table, column, row)));
}

// Of a row with its period of sale; `named` are the modes of all rows.
void read_row(const Table& table, const TriangleColumns& columns,
              const std::vector<Heading>& headings, const ModeWords& words, std::size_t row,
              SalesPeriod& sale, std::vector<std::string>& named) {
  ModeReturns own;
  own.row = row;
  own.returns = read_returns(table, columns.quantity, headings, row, sale);
  if (columns.mode.empty()) return;
  const bool any =
      std::any_of(own.returns.begin(), own.returns.end(), [](int count) { return count > 0; });
  const std::vector<std::string> modes = modes_of_row(table, columns.mode, row, words, any);
  for (const std::string& mode : modes)
    if (!contains(named, mode)) named.push_back(mode);
  if (!any) return;
  own.mode = fmt::format("{}", fmt::join(modes, "|"));
  for (const ModeReturns& each : sale.by_mode)
    if (each.mode == own.mode)
      throw InputError(
          fmt::format("{}: the same period of sale and failure mode as in row {}; add them up",
                      quoted_place(table, columns.mode, row), each.row + 1));
  sale.by_mode.push_back(std::move(own));
}

// The units sold in the period of these rows; it may stand in one of them.
int sold_in(const Table& table, const TriangleColumns& columns,
            const std::vector<std::size_t>& rows) {
  int sold = -1;
  std::size_t of = 0;
  for (const std::size_t row : rows) {
    if (cell_word(table.column(columns.quantity), row).empty()) continue;
    const int units = units_in(table, columns.quantity, row, -1);
    if (sold >= 0 && units != sold)
      throw InputError(fmt::format(
          "{}: {} units sold, but {} in row {} of the same period; each row of a failure mode has "
          "all units of its period, or an empty cell",
          place(table, columns.quantity, row), units, sold, of + 1));
    sold = units;
    of = row;
  }
  return sold >= 0 ? sold : units_in(table, columns.quantity, rows.front(), -1);
}

// The rows of each period of sale: one, or one for each failure mode.
std::map<int, std::vector<std::size_t>> rows_of_periods(const Table& table,
                                                        const TriangleColumns& columns,
                                                        const std::vector<Heading>& headings) {
  std::map<int, std::vector<std::size_t>> rows;
  std::string prefix = headings.front().period.prefix;
  const PeriodColumn sold(table.column(columns.period));
  for (std::size_t row = 0; row < table.rows; ++row) {
    const Period period = period_of_sale(table, sold, row, headings.front());
    require_kind(table, columns.period, row, period, prefix);
    std::vector<std::size_t>& of = rows[period.number];
    if (!of.empty() && columns.mode.empty())
      throw InputError(
          fmt::format("{}: the same period of sale as in row {}; add them up, or name the column "
                      "of failure modes: [data.returns] mode",
                      quoted_place(table, columns.period, row), of.front() + 1));
    if (period.number > headings.back().period.number)
      throw InputError(
          fmt::format("{}: sold after '{}', the last column of returns; sales to come belong to "
                      "predict.planned_sales",
                      quoted_place(table, columns.period, row), headings.back().column->name));
    of.push_back(row);
  }
  return rows;
}

}  // namespace

int SalesPeriod::returned(int until) const {
  const std::ptrdiff_t count =
      std::clamp<std::ptrdiff_t>(until - at + 1, 0, static_cast<std::ptrdiff_t>(returns.size()));
  return std::accumulate(returns.begin(), returns.begin() + count, 0);
}

std::string PeriodNames::text(int period) const {
  return calendar ? month_text(period) : fmt::format("{}{}", prefix, period);
}

std::optional<TriangleColumns> triangle_columns(const Table& table) {
  const std::vector<Heading> headings = in_order(period_headings(table, {}));
  if (headings.size() < 2) return {};
  for (std::size_t i = 1; i < headings.size(); ++i) {
    if (!headings[i].period.is_like(headings[0].period) ||
        headings[i].period.number != headings[i - 1].period.number + 1)
      return {};
  }
  TriangleColumns columns;
  const int first = headings.front().period.number, last = headings.back().period.number;
  std::vector<const Column*> quantities;
  bool before_returns = true;
  for (const Column& each : table.columns) {
    if (period_in(each.name)) {
      before_returns = false;
      continue;
    }
    std::size_t periods = 0;
    const PeriodColumn cells(each);
    for (std::size_t row = 0; row < table.rows; ++row) {
      const auto period = cells.at(row);
      // A quantity is a number, too.
      periods += period && period->calendar == headings[0].period.calendar &&
                 (period->calendar || (period->number >= first - 1 && period->number <= last));
    }
    // Most cells: messages name the others.
    if (2 * periods > table.rows && columns.period.empty()) {
      columns.period = each.name;
      continue;
    }
    columns.unread.push_back(each.name);
    // Numbers after the returns are their totals.
    if (before_returns && (each.is_number || !each.doubt.empty())) quantities.push_back(&each);
  }
  if (const Column* quantity = quantity_among(quantities)) {
    columns.quantity = quantity->name;
    std::erase(columns.unread, quantity->name);
  }
  columns.first = headings.front().column->name;
  columns.last = headings.back().column->name;
  columns.calendar = headings.front().period.calendar;
  columns.prefix = headings.front().period.prefix;
  if (columns.period.empty() || columns.quantity.empty()) return {};
  return columns;
}

ReturnsTriangle read_triangle(const TomlReader& keys, Table table, const ModeWords& words) {
  const TriangleColumns found = triangle_columns(table).value_or(TriangleColumns{});
  const TriangleColumns columns = {column_named(keys, "sold", table, found.period),
                                   column_named(keys, "quantity", table, found.quantity),
                                   keys.has("mode") ? column_named(keys, "mode", table, "") : ""};
  if (columns.period == columns.quantity)
    keys.fail("quantity", fmt::format("is the column of `sold`, '{}'", columns.period));
  if (columns.mode == columns.period || columns.mode == columns.quantity)
    keys.fail("mode", fmt::format("is the column of the units sold, '{}'", columns.mode));
  return read_triangle(keys, std::move(table), columns, words);
}

ReturnsTriangle read_triangle(const TomlReader& keys, Table table, const TriangleColumns& columns,
                              const ModeWords& words) {
  ReturnsTriangle triangle;
  const std::vector<Heading> headings = ordered_headings(keys, table, columns);
  triangle.names = {headings.front().period.calendar, headings.front().period.prefix};
  require_consecutive(table, headings, triangle.names);
  require_last_column(table, headings.back());
  triangle.last = headings.back().period.number;
  for (const auto& [at, rows] : rows_of_periods(table, columns, headings)) {
    SalesPeriod sale{at, sold_in(table, columns, rows)};
    sale.row = rows.front();
    for (const std::size_t row : rows)
      read_row(table, columns, headings, words, row, sale, triangle.modes);
    if (sale.sold > 0) triangle.sales.push_back(std::move(sale));
  }
  triangle.first = headings.front().period.number;
  if (triangle.sales.empty())
    throw InputError(fmt::format("{}: no units were sold ('{}')", table.source, columns.quantity));
  for (const Column& each : table.columns) {
    const bool used =
        each.name == columns.period || each.name == columns.quantity || each.name == columns.mode ||
        std::any_of(headings.begin(), headings.end(),
                    [&](const Heading& heading) { return heading.column->name == each.name; });
    if (!used) triangle.unread.push_back(each.name);
  }
  triangle.period_column = columns.period;
  triangle.quantity_column = columns.quantity;
  triangle.mode_column = columns.mode;
  triangle.table = std::move(table);
  return triangle;
}

std::vector<std::pair<int, int>> read_planned_sales(const TomlReader& keys, const Table& table,
                                                    const PeriodNames& names, int last) {
  const auto heading = [&](const char* key, std::size_t otherwise) {
    return column_named(keys, key, table,
                        otherwise < table.columns.size() ? table.columns[otherwise].name : "");
  };
  const std::string period_column = heading("sold", 0), quantity_column = heading("quantity", 1);
  std::string prefix = names.prefix;
  std::vector<std::pair<int, int>> planned;
  const PeriodColumn sold(table.column(period_column));
  for (std::size_t row = 0; row < table.rows; ++row) {
    const Period period = required_period(table, sold, row);
    if (period.calendar != names.calendar)
      throw InputError(fmt::format("{} must be {}, as in the returns",
                                   quoted_place(table, period_column, row),
                                   names.calendar ? "a month" : "the number of a period"));
    require_kind(table, period_column, row, period, prefix);
    if (period.number <= last)
      throw InputError(
          fmt::format("{} is not after {}, the last period of returns: it is no planned sale",
                      quoted_place(table, period_column, row), names.text(last)));
    const bool repeated = std::any_of(planned.begin(), planned.end(), [&](const auto& each) {
      return each.first == period.number;
    });
    if (repeated)
      throw InputError(fmt::format("{}: a second row of this period; add them up",
                                   quoted_place(table, period_column, row)));
    planned.emplace_back(period.number, units_in(table, quantity_column, row, -1));
  }
  std::sort(planned.begin(), planned.end());
  return planned;
}

}  // namespace wearwell::formula_model
