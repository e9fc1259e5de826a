#include "wearwell/input/columns.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {

std::optional<ColumnChoice> read_column(const TomlReader& columns, const std::string& name,
                                        const std::string& si) {
  if (!columns.has(name)) return {};
  if (columns.is_text(name)) {
    if (!may_be_plain(si)) {
      columns.fail(name, fmt::format("needs a unit: {} = {{ column = \"{}\", unit = \"{}\" }}",
                                     name, *columns.text(name), si));
    }
    return ColumnChoice{*columns.text(name), Unit{"1", 1, 0}};
  }
  const TomlReader table = columns.required_table(name);
  ColumnChoice choice{table.required_text("column"), Unit{"1", 1, 0}};
  const auto unit = table.text("unit");
  if (!unit && !may_be_plain(si))
    table.fail("unit", fmt::format("is missing (one like \"{}\")", si));
  if (unit) {
    try {
      choice.unit = read_unit(*unit, si);
    } catch (const InputError& error) {
      table.fail("unit", error.what());
    }
  }
  return choice;
}

ColumnChoice required_column(const TomlReader& columns, const std::string& name,
                             const std::string& si) {
  const auto choice = read_column(columns, name, si);
  if (!choice) {
    columns.fail(name, may_be_plain(si)
                           ? "is missing: which column holds it?"
                           : fmt::format("is missing: {} = {{ column = \"...\", unit = \"{}\" }}",
                                         name, si));
  }
  return *choice;
}

void require(bool good, const Table& table, const ColumnChoice& choice, std::size_t row,
             const char* allowed) {
  if (good) return;
  const Column& column = table.column(choice.column);
  const std::string value =
      column.is_number ? fmt::format("{}", column.numbers[row]) : column.text[row];
  throw InputError(
      fmt::format("{}: {} must be {}", place(table, choice.column, row), value, allowed));
}

}  // namespace wearwell
