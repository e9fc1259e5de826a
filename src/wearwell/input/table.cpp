#include "wearwell/input/table.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/thousands.h"

namespace wearwell {

const Column& Table::column(std::string_view name) const {
  std::vector<std::string> names;
  for (const Column& each : columns) {
    if (each.name == name) return each;
    names.push_back(each.name);
  }
  throw InputError(fmt::format("{} has no column '{}' (nearest: '{}')", source, name,
                               nearest_name(name, names)));
}

std::string place(const Table& table, std::string_view column, std::size_t index) {
  return fmt::format("{}, row {}, column '{}'", table.source, index + 1, column);
}

double cell_number(const Table& table, const Column& column, std::size_t index) {
  if (column.is_number) return column.numbers[index];
  const std::string& text = column.text[index];
  double value = NAN;
  const auto [rest, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (!text.empty() && (failure != std::errc{} || rest != text.data() + text.size()))
    throw InputError(fmt::format("{}: {}", place(table, column.name, index), not_a_number(text)));
  return value;
}

namespace {

/// Of numbers that came as text (in JSON, through SQL): refuses dots all of which may be marks for
/// thousands.
void refuse_thousands_marks(const Table& table, const Column& column) {
  std::optional<std::size_t> doubtful;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const std::string& text = column.text[i];
    if (text.find('.') == text.npos) continue;
    if (!may_have_thousands_mark(text)) return;  // a dot that is a decimal mark
    if (!doubtful) doubtful = i;
  }
  if (doubtful)
    throw InputError(fmt::format("{}: {}", place(table, column.name, *doubtful),
                                 two_readings(column.text[*doubtful])));
}

}  // namespace

std::vector<double> si_numbers(const Table& table, std::string_view name, const Unit& unit) {
  const Column& column = table.column(name);
  std::vector<double> values;
  values.reserve(table.rows);
  for (std::size_t i = 0; i < table.rows; ++i) values.push_back(cell_number(table, column, i));
  if (!column.is_number) refuse_thousands_marks(table, column);
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (!std::isfinite(values[i])) {
      throw InputError(
          fmt::format("{}: {}", place(table, name, i),
                      std::isnan(values[i]) ? "no value (empty or NaN)" : "the value is infinite"));
    }
    const double si = to_si(unit, values[i]);
    if (!std::isfinite(si))
      throw InputError(fmt::format("{}: {} {} is too large a number", place(table, name, i),
                                   values[i], unit.text));
    values[i] = si;
  }
  return values;
}

}  // namespace wearwell
