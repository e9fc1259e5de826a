#include "wearwell/table/table.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"

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

std::vector<double> si_numbers(const Table& table, std::string_view name, const Unit& unit) {
  const Column& column = table.column(name);
  std::vector<double> values = column.numbers;
  if (!column.is_number) {
    // DuckDB read the column as text because of at least one cell; find it.
    for (std::size_t i = 0; i < table.rows; ++i) {
      const std::string& text = column.text[i];
      double value = NAN;
      const auto [rest, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (!text.empty() && (failure != std::errc{} || rest != text.data() + text.size())) {
        throw InputError(fmt::format("{}: '{}' is not a number", place(table, name, i), text));
      }
      values.push_back(value);
    }
  }
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (!std::isfinite(values[i])) {
      throw InputError(
          fmt::format("{}: {}", place(table, name, i),
                      std::isnan(values[i]) ? "no value (empty or NaN)" : "the value is infinite"));
    }
    values[i] = to_si(unit, values[i]);
  }
  return values;
}

}  // namespace wearwell
