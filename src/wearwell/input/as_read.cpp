#include "wearwell/input/as_read.h"

#include <fmt/format.h>

#include <algorithm>

namespace wearwell {
namespace {

// The layout settings of the section.
std::string settings_text(const TomlReader& section) {
  const TableSettings settings = read_table_settings(section);
  std::string words;
  const auto add = [&](const char* key, const auto& value) {
    if (!value) return;
    if constexpr (std::is_same_v<std::decay_t<decltype(*value)>, char>) {
      words += fmt::format("\n{} = {}", key, static_cast<int>(*value));
    } else {
      words += fmt::format("\n{} = {}", key, *value);
    }
  };
  add("decimal", settings.decimal);
  add("thousands", settings.thousands);
  add("delimiter", settings.delimiter);
  if (settings.encoding)
    words += fmt::format("\nencoding = {}", static_cast<int>(*settings.encoding));
  add("header_row", settings.header_row);
  add("units_row", settings.units_row);
  add("summary_rows", settings.summary_rows);
  add("hidden_rows", settings.hidden_rows);
  add("comment", settings.comment);
  add("sheet", settings.sheet);
  add("range", settings.range);
  return words;
}

}  // namespace

std::string as_read_name(const TomlReader& section) {
  const auto sql = section.text("sql");
  return fmt::format("as read\n{}{}{}", section.required_text("file"), settings_text(section),
                     sql ? "\nsql = " + *sql : "");
}

std::string before_sql_name(const TomlReader& section) {
  return fmt::format("before sql\n{}{}", section.required_text("file"), settings_text(section));
}

const Table* table_in_memory(const TomlReader& section, const Source& source) {
  auto found = source.tables.find(as_read_name(section));
  if (found == source.tables.end()) found = source.tables.find(section.required_text("file"));
  return found == source.tables.end() ? nullptr : &found->second;
}

bool holds_numbers(const Column& column) {
  if (column.is_number) return true;
  return column.marks && column.doubt.empty() &&
         std::all_of(column.text.begin(), column.text.end(), [&](const std::string& text) {
           return text.empty() || plain_number(text, *column.marks);
         });
}

}  // namespace wearwell
