#include "wearwell/models/formula_model/returns_period.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/date_text.h"
#include "wearwell/input/month_text.h"
#include "wearwell/input/status_words.h"

namespace wearwell::formula_model {
namespace {

constexpr double most_units = 1e6;  // of one period

}  // namespace

std::optional<Period> period_in(const std::string& text) {
  constexpr std::size_t most_digits = 4;
  if (const auto month = month_in(text)) return Period{true, *month};
  static const std::vector<std::string> words = {
      "",       "m",  "p",    "w",     "q",       "month",   "monat", "mois",   "mes",
      "period", "kw", "week", "woche", "semaine", "periode", "t",     "quarter"};
  const std::size_t end = text.find_last_not_of("0123456789");
  const std::size_t begin = end == text.npos ? 0 : end + 1;
  const std::size_t digits = text.size() - begin;
  if (digits == 0 || digits > most_digits) return {};
  if (!contains(words, begin == 0 ? "" : folded_word(text.substr(0, begin)))) return {};
  return Period{false, std::stoi(text.substr(begin)), text.substr(0, begin)};
}

PeriodColumn::PeriodColumn(const Column& column) : column_(column) {
  const std::vector<std::string> layouts = date_layouts(column);
  // A year of two digits may be the day.
  if (layouts.size() != 1 || layouts.front().find("%y") != std::string::npos) return;
  const bool all = std::all_of(
      column.text.begin(), column.text.end(),
      [&](const std::string& cell) { return is_blank(cell) || date_in(cell, layouts.front()); });
  if (all) layout_ = layouts.front();
}

std::optional<Period> PeriodColumn::at(std::size_t row) const {
  using namespace std::chrono;
  const std::string cell = cell_word(column_, row);
  const auto date = layout_.empty() ? std::nullopt : date_in(cell, layout_);
  if (!date) return period_in(cell);
  const year_month_day day{floor<days>(sys_seconds(seconds(*date)))};
  return Period{true, 12 * static_cast<int>(day.year()) +
                          static_cast<int>(static_cast<unsigned>(day.month())) - 1};
}

std::string quoted_place(const Table& table, const std::string& column, std::size_t row) {
  return fmt::format("{}: '{}'", place(table, column, row), cell_word(table.column(column), row));
}

Period required_period(const Table& table, const PeriodColumn& column, std::size_t row) {
  const auto period = column.at(row);
  if (!period)
    throw InputError(fmt::format("{} is not a period of sale: use {}",
                                 quoted_place(table, column.name(), row), allowed_months));
  return *period;
}

int units_in(const Table& table, const std::string& column, std::size_t row, int empty) {
  const double value = cell_number(table, table.column(column), row);
  if (std::isnan(value)) {
    if (empty >= 0) return empty;
    throw InputError(fmt::format("{}: no quantity; write the number of units sold, 0 if none",
                                 place(table, column, row)));
  }
  if (!(value >= 0 && value == std::floor(value) && value <= most_units))
    throw InputError(fmt::format("{} must be a whole number of units from 0 to {:.0f}",
                                 quoted_place(table, column, row), most_units));
  return static_cast<int>(value);
}

void require_kind(const Table& table, const std::string& column, std::size_t row,
                  const Period& period, std::string& prefix) {
  if (period.calendar || period.prefix.empty()) return;
  if (prefix.empty()) prefix = period.prefix;
  if (folded_word(period.prefix) == folded_word(prefix)) return;
  throw InputError(
      fmt::format("{} is a period of another kind than those that begin with '{}': write all "
                  "periods of the table in one way",
                  quoted_place(table, column, row), prefix));
}

std::string column_named(const TomlReader& keys, const std::string& key, const Table& table,
                         const std::string& otherwise) {
  if (const auto heading = keys.text(key)) return study_column(keys, key, *heading, table).name;
  if (otherwise.empty())
    keys.fail(key, fmt::format("is missing, and no column of {} is recognized: name the column",
                               table.source));
  return otherwise;
}

}  // namespace wearwell::formula_model
