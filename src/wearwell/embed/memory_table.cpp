#include "wearwell/embed/memory_table.h"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace wearwell::embed {

void add_column(Table& table, Column column) {
  const std::size_t rows = column.is_number ? column.numbers.size() : column.text.size();
  if (!table.columns.empty() && rows != table.rows) {
    throw InputError(fmt::format("{}: column '{}' has {} rows, and '{}' has {}", table.source,
                                 column.name, rows, table.columns.front().name, table.rows));
  }
  table.rows = rows;
  table.columns.push_back(std::move(column));
}

void refuse_no_table(const Table& table) {
  if (table.columns.empty()) throw InputError(fmt::format("{} has no columns", table.source));
  if (table.rows == 0) throw InputError(fmt::format("{} has no rows", table.source));
  std::set<std::string> names;
  for (const Column& each : table.columns) {
    if (!names.insert(each.name).second)
      throw InputError(fmt::format("{}: two columns are called '{}'", table.source, each.name));
  }
}

void add_units(Table& table, const std::map<std::string, std::string>& units) {
  for (const auto& [heading, unit] : units) {
    const Column& column = table.column(heading);
    for (Column& each : table.columns) {
      if (&each == &column) each.unit = unit;
    }
  }
}

}  // namespace wearwell::embed
