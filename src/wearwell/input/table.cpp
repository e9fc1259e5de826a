#include "wearwell/input/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/number_text.h"
#include "wearwell/input/readable_cell.h"

namespace wearwell {

std::string remarks_suffix(const std::vector<std::string>& remarks) {
  return remarks.empty() ? "" : fmt::format("; {}", fmt::join(remarks, "; "));
}

const Column& Table::column(std::string_view name) const {
  const auto refuse_two = [&](const Column& a, const Column& b) {
    throw InputError(fmt::format(
        "{} has two columns of '{}': '{}' (column {}) and '{}' (column {}). Use the whole heading "
        "of one, or rename one if both are the same",
        source, name, a.name, &a - columns.data() + 1, b.name, &b - columns.data() + 1));
  };
  // Headings are taken apart only where none is the whole name: rows ask for their column, too.
  const Column* found = nullptr;
  const auto look = [&](const auto& is_named) {
    for (const Column& each : columns) {
      if (!is_named(each)) continue;
      if (found) refuse_two(*found, each);
      found = &each;
    }
  };
  look([&](const Column& each) { return each.name == name; });
  if (!found) look([&](const Column& each) { return read_heading(each.name, "").name == name; });
  if (found) return *found;
  std::vector<std::string> names;
  for (const Column& each : columns) names.push_back(each.name);
  throw InputError(fmt::format("{} has no column '{}' (nearest: '{}')", source, name,
                               nearest_name(name, names)));
}

std::string row_name(std::size_t row, std::size_t line) {
  if (line == 0 || line == row + 1) return fmt::format("row {}", row);
  return fmt::format("row {} (line {})", row, line);
}

std::string place(const Table& table, std::string_view column, std::size_t index) {
  const std::size_t row = table.origins.empty() ? index : table.origins[index] - 1;
  return fmt::format("{}, {}, column '{}'", table.source,
                     row_name(row + 1, table.lines.empty() ? 0 : table.lines[row]), column);
}

namespace {

double c_number(std::string_view text) {
  double value = NAN;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

[[noreturn]] void refuse_cell(const Table& table, const Column& column, std::size_t index) {
  const std::string& text = column.text[index];
  const bool other_marks = column.marks && number_form(text).kind == NumberForm::Kind::number;
  throw InputError(fmt::format("{}: {}", place(table, column.name, index),
                               other_marks ? fmt::format("'{}' is not a number with a decimal {}",
                                                         text, mark_name(column.marks->decimal))
                                           : not_a_number(text)));
}

}  // namespace

std::optional<CellValue> readable_cell(const Table&, const Column& column, std::size_t index) {
  if (!column.doubt.empty()) return {};
  if (column.is_number) return CellValue{column.numbers[index]};
  const std::string& text = column.text[index];
  if (is_absent(text)) return CellValue();
  const auto found = cell_text(text);
  CellValue value;
  if (found) value.sign = found->sign;
  if (found && found->number.empty()) {
    value.unstated = true;
    return value;
  }
  const std::string_view number = found ? found->number : std::string_view(text);
  if (column.marks) {
    const auto plain = wearwell::plain_number(number, *column.marks);
    if (!plain) return {};
    value.number = c_number(*plain);
    return value;
  }
  const bool foreign_unit = found && !found->unit.empty();  // the table has no such unit
  const auto [rest, failure] =
      std::from_chars(number.data(), number.data() + number.size(), value.number);
  if (failure != std::errc{} || rest != number.data() + number.size() || foreign_unit) return {};
  return value;
}

CellValue cell_value(const Table& table, const Column& column, std::size_t index) {
  if (!column.doubt.empty()) throw InputError(fmt::format("{}, {}", table.source, column.doubt));
  const auto value = readable_cell(table, column, index);
  if (!value) refuse_cell(table, column, index);
  return *value;
}

double cell_number(const Table& table, const Column& column, std::size_t index) {
  const CellValue value = cell_value(table, column, index);
  if (value.sign == 0) return value.number;
  throw InputError(
      fmt::format("{}: '{}' is a limit (the value lies {} it), but a value is needed here. Such "
                  "{}-censored rows are allowed for the life of a test and for the response of a "
                  "formula (model = \"formula\") (docs/reference/tables.md)",
                  place(table, column.name, index), column.text[index],
                  value.sign == '<' ? "below" : "above", value.sign == '<' ? "left" : "right"));
}

namespace {

/// For numbers that arrive as text (JSON, SQL): refuses them if every dot may be a thousands
/// separator.
void refuse_thousands_marks(const Table& table, const Column& column) {
  std::optional<std::size_t> doubtful;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const std::string& text = column.text[i];
    if (text.find('.') == text.npos) continue;
    if (number_form(text).doubtful != '.') return;  // this dot is a decimal point
    if (!doubtful) doubtful = i;
  }
  if (doubtful)
    throw InputError(fmt::format("{}: {}", place(table, column.name, *doubtful),
                                 two_readings(column.text[*doubtful])));
}

}  // namespace

namespace {

// Limits for which cubes of measured values and their reciprocals are finite. Plain numbers may
// have any size.
constexpr double smallest_si = 1e-100, largest_si = 1e100;

// The message of a missing value, with a query that omits such rows.
std::string no_value(const Table& table, const Column& column) {
  std::string words = "no value (empty or NaN)";
  if (!table.layout.text.empty() && column.name.find_first_of("\"\\\n") == std::string::npos)
    words += fmt::format(
        "; to omit such rows: sql = 'select * from data where \"{}\" is not null' in [data], "
        "or "
        "--sql of select",
        column.name);
  return words;
}

}  // namespace

std::vector<double> si_numbers(const Table& table, std::string_view name, const Unit& unit) {
  const Column& column = table.column(name);
  std::vector<double> values;
  values.reserve(table.rows);
  for (std::size_t i = 0; i < table.rows; ++i) values.push_back(cell_number(table, column, i));
  if (!column.is_number && !column.marks) refuse_thousands_marks(table, column);
  const bool measured = unit.text != "1";
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (!std::isfinite(values[i])) {
      throw InputError(
          fmt::format("{}: {}", place(table, name, i),
                      std::isnan(values[i]) ? no_value(table, column) : "the value is infinite"));
    }
    const double si = to_si(unit, values[i]);
    if (!std::isfinite(si) || (measured && !(std::abs(si) < largest_si)))
      throw InputError(fmt::format("{}: {} {} is too large a number", place(table, name, i),
                                   values[i], unit.text));
    if (measured && si != 0 && std::abs(si) < smallest_si)
      throw InputError(
          fmt::format("{}: {} {} is too small to compute with: {:.3g} in SI units (0, or at least "
                      "{:.0e}); check the unit",
                      place(table, name, i), values[i], unit.text, si, smallest_si));
    values[i] = si;
  }
  return values;
}

}  // namespace wearwell
