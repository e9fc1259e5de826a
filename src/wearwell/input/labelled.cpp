#include "wearwell/input/labelled.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/heading.h"

namespace wearwell {
namespace {

ColumnChoice labelled(const Table& table, const Column& column, std::string_view name,
                      std::string_view si, std::string_view option) {
  const bool has_unit = !column.unit.empty() || !read_heading(column.name, si).unit.empty();
  if (!has_unit && !may_be_plain(si))
    throw InputError(fmt::format(
        "{}, column '{}' has no unit: {}", table.source, column.name,
        option.empty() ? fmt::format("name it '{} [{}]'", name, si)
                       : fmt::format("write {} '{}={}:{}'", option, name, column.name, si)));
  return {column.name, column_unit(table, column, std::string(si), {})};
}

}  // namespace

ColumnChoice find_labelled(const std::vector<std::string>& headings, std::string_view name,
                           std::string_view si, const std::string& source,
                           std::string_view option) {
  Table table;
  table.source = source;
  for (const std::string& heading : headings) table.columns.push_back({heading, true, {}, {}});
  return find_labelled(table, name, si, option);
}

ColumnChoice find_labelled(const Table& table, std::string_view name, std::string_view si,
                           std::string_view option) {
  std::vector<std::string> names;
  const Column* found = nullptr;
  for (const Column& column : table.columns) {
    names.push_back(read_heading(column.name, si).name);
    if (column.name != name && names.back() != name) continue;
    if (found)
      throw InputError(fmt::format(
          "{} has two columns of '{}': '{}' (column {}) and '{}' (column {}): {}", table.source,
          name, found->name, found - table.columns.data() + 1, column.name, names.size(),
          option.empty() ? "rename or remove one of them"
                         : fmt::format("choose one by {} '{}=COLUMN:{}'", option, name, si)));
    found = &column;
  }
  if (found) return labelled(table, *found, name, si, option);
  const auto nearest = std::find(names.begin(), names.end(), nearest_name(name, names));
  throw InputError(
      fmt::format("{} has no column '{}{}' (nearest: '{}')", table.source, name,
                  may_be_plain(si) ? "" : fmt::format(" [{}]", si),
                  table.columns[static_cast<std::size_t>(nearest - names.begin())].name));
}

}  // namespace wearwell
