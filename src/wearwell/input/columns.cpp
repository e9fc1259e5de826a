#include "wearwell/input/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_hint.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/heading.h"

namespace wearwell {

namespace {

constexpr double most_repeated = 1e6;  // rows

/// The unit of a column according to the table.
struct WrittenUnit {
  std::string text = {};      ///< empty without a unit
  bool may_be_index = false;  ///< "radius_m" may be the mean radius
};

WrittenUnit written_unit(const Column& column, const std::string& si) {
  if (!column.unit.empty()) return {bare_unit(column.unit)};
  const Heading heading = read_heading(column.name, si);
  return {heading.unit, heading.suffix && heading.unit.size() == 1};
}

bool same(const Unit& a, const Unit& b) {
  const auto near = [](double x, double y) {
    return std::abs(x - y) <= 1e-12 * std::max(std::abs(x), std::abs(y));
  };
  return near(a.scale, b.scale) && near(a.offset, b.offset);
}

/// Where a column states its unit.
const char* unit_place(const Column& column) {
  if (column.unit.empty()) return "heading";
  return column.unit_in_cells ? "cells" : "row of units";
}

bool is_any_unit(const std::string& text) {
  return parse_unit(text).has_value();
}

Unit read_written(const Table& table, const Column& column, const std::string& text,
                  const std::string& si) {
  try {
    return read_unit(text, si);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}, column '{}': {}", table.source, column.name, error.what()));
  }
}

/// The heading that the study names, and the unit if it names one.
struct NamedColumn {
  std::string column;
  std::optional<Unit> unit;
};

std::optional<NamedColumn> read_name(const TomlReader& columns, const std::string& name,
                                     const std::string& si) {
  if (!columns.has(name)) return {};
  if (columns.is_text(name)) return NamedColumn{*columns.text(name), {}};
  const TomlReader table = columns.required_table(name);
  NamedColumn named{table.required_text("column"), {}};
  if (const auto unit = table.text("unit")) {
    try {
      named.unit = read_unit(*unit, si);
    } catch (const InputError& error) {
      table.fail("unit", error.what());
    }
  }
  return named;
}

}  // namespace

const Column& study_column(const TomlReader& columns, const std::string& name,
                           const std::string& heading, const Table& table) {
  try {
    return table.column(heading);
  } catch (const InputError& error) {
    std::vector<std::string> headings;
    for (const Column& each : table.columns) headings.push_back(each.name);
    const auto near = near_name(heading, headings);
    columns.fail(name, error.what(), near ? Repair{heading, *near} : Repair{});
  }
}

std::string no_unit_of(const Table& table, const Column& column, const std::string& name,
                       const std::string& unit, const std::string& why) {
  return fmt::format(
      "{}, column '{}': {}. Text in brackets{} is the column's unit; if it is a remark, state the "
      "unit: {} = {{ column = \"{}\", unit = \"{}\" }}",
      table.source, column.name, why, column.unit.empty() ? "" : " or in the row of units", name,
      column.name, unit);
}

Unit column_unit(const Table& table, const Column& column, const std::string& si,
                 const std::optional<Unit>& given) {
  const WrittenUnit written = written_unit(column, si);
  if (!given) {
    if (written.text.empty()) return Unit{"1", 1, 0};
    return read_written(table, column, written.text, si);
  }
  // Brackets may contain a remark instead of a unit: "volume [corrected]". A factor is part of a
  // unit.
  const std::string text = without_times(written.text);
  if (text.empty() || !is_any_unit(text)) return *given;
  if (written.may_be_index) return *given;
  const Unit read = read_written(table, column, text, si);
  if (!same(read, *given))
    throw InputError(fmt::format(
        "{0}, column '{1}' is in {2} by its {3}, and {4} is given as its unit (1 {2} is {5:.6g} "
        "{4}); "
        "keep one of them, or make both equal",
        table.source, column.name, written.text, unit_place(column), given->text,
        read.scale / given->scale));
  return *given;
}

std::optional<ColumnChoice> read_column(const TomlReader& columns, const std::string& name,
                                        const std::string& si, const Table& table) {
  const auto named = read_name(columns, name, si);
  if (!named) return {};
  const Column& column = study_column(columns, name, named->column, table);
  const WrittenUnit written = written_unit(column, si);
  if (!named->unit && written.text.empty() && !may_be_plain(si)) {
    const std::string quoted = fmt::format("\"{}\"", named->column);
    const std::string with_unit = fmt::format("{}, unit = \"{}\"", quoted, si);
    columns.fail(
        name,
        fmt::format("needs a unit: {} = {{ column = \"{}\", unit = \"{}\" }}, or "
                    "'{} [{}]' as the heading in {}",
                    name, column.name, si, column.name, si, table.source),
        {quoted, columns.is_text(name) ? fmt::format("{{ column = {} }}", with_unit) : with_unit});
  }
  if (!named->unit && !written.text.empty() && !is_any_unit(written.text)) {
    try {
      read_unit(written.text, si);
    } catch (const InputError& error) {
      columns.fail(name, no_unit_of(table, column, name, si, error.what()));
    }
  }
  return ColumnChoice{column.name, column_unit(table, column, si, named->unit)};
}

ColumnChoice required_column(const TomlReader& columns, const std::string& name,
                             const std::string& si, const Table& table) {
  const auto choice = read_column(columns, name, si, table);
  if (!choice) {
    columns.fail(name, may_be_plain(si)
                           ? "is missing: which column holds it?"
                           : fmt::format("is missing: {} = {{ column = \"...\", unit = \"{}\" }}",
                                         name, si));
  }
  return *choice;
}

std::optional<ColumnChoice> read_word_column(const TomlReader& columns, const std::string& name,
                                             const Table& table) {
  const auto named = read_name(columns, name, "1");
  if (!named) return {};
  return ColumnChoice{study_column(columns, name, named->column, table).name, Unit{"1", 1, 0}};
}

std::string cell_word(const Column& column, std::size_t row) {
  if (!column.is_number) return is_blank(column.text[row]) ? "" : column.text[row];
  return std::isnan(column.numbers[row]) ? "" : fmt::format("{}", column.numbers[row]);
}

std::string label_word(const Table& table, const Column& column, std::size_t row) {
  std::string word = cell_word(column, row);
  if (!word.empty()) return word;
  std::string above;
  for (std::size_t i = row; above.empty() && i-- > 0;) above = cell_word(column, i);
  throw InputError(fmt::format(
      "{}: no value; a label must not be empty{}", place(table, column.name, row),
      above.empty() ? std::string()
                    : fmt::format(": it can mean '{}', the label of the rows above, or no label; "
                                  "write the label in each row, or a separate word for no label",
                                  printable(above))));
}

CensoredNumbers censored_numbers(const Table& table, const ColumnChoice& choice) {
  const Column& column = table.column(choice.column);
  CensoredNumbers all;
  Table values;  // the limits as values
  values.source = table.source;
  values.rows = table.rows;
  values.layout = table.layout;
  values.lines = table.lines;
  values.origins = table.origins;
  values.columns.push_back({column.name, true, {}, {}});
  for (std::size_t i = 0; i < table.rows; ++i) {
    const CellValue cell = cell_value(table, column, i);
    if (cell.unstated) refuse_unstated_limit(table, column, i);
    values.columns[0].numbers.push_back(cell.number);
    all.seen.push_back(cell.sign == 0     ? Censoring::none
                       : cell.sign == '>' ? Censoring::right
                                          : Censoring::left);
  }
  const bool any_limit = std::any_of(all.seen.begin(), all.seen.end(),
                                     [](Censoring each) { return each != Censoring::none; });
  all.values = any_limit ? si_numbers(values, column.name, choice.unit) : si_numbers(table, choice);
  return all;
}

void refuse_unstated_limit(const Table& table, const Column& column, std::size_t row,
                           const std::string& key) {
  throw InputError(
      fmt::format("{}: '{}' does not state its limit: write it in the cell, as in <0.05{}",
                  place(table, column.name, row), column.text[row],
                  key.empty() ? "" : ", or in the study: " + key));
}

std::vector<double> kelvins(const Table& table, const ColumnChoice& choice) {
  std::vector<double> values = si_numbers(table, choice);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < 0)
      throw InputError(fmt::format("{}: {:.6g} is below absolute zero",
                                   place(table, choice.column, i),
                                   from_si(choice.unit, values[i])));
  }
  return values;
}

Table with_counts(const TomlReader& columns, Table table) {
  const auto count = read_column(columns, "count", "1", table);
  if (!count) return table;
  const std::vector<double> counts = si_numbers(table, *count);
  double sum = 0;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < table.rows; ++i) {
    require(
        counts[i] >= 1 && counts[i] == std::floor(counts[i]) && (sum += counts[i]) <= most_repeated,
        table, *count, i, "a whole number from 1, with a sum of at most 1000000");
    rows.insert(rows.end(), static_cast<std::size_t>(counts[i]), i);
  }
  for (Column& column : table.columns) {
    const Column once = column;
    column.numbers.clear();
    column.text.clear();
    for (const std::size_t i : rows) {
      if (once.is_number) {
        column.numbers.push_back(once.numbers[i]);
      } else {
        column.text.push_back(once.text[i]);
      }
    }
  }
  table.rows = rows.size();
  for (const std::size_t i : rows) table.origins.push_back(i + 1);
  return table;
}

void require(bool good, const Table& table, const ColumnChoice& choice, std::size_t row,
             const char* allowed) {
  if (good) return;
  throw InputError(fmt::format("{}: {} must be {}", place(table, choice.column, row),
                               cell_word(table.column(choice.column), row), allowed));
}

}  // namespace wearwell
