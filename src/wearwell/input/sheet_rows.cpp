#include "wearwell/input/sheet_rows.h"

#include <fmt/format.h>

#include <string_view>

#include "wearwell/base/error.h"

namespace wearwell {

SheetRange read_sheet_range(const std::string& text, const std::string& source) {
  std::string_view rest;
  SheetRange range{read_cell_name(text, rest), {}};
  if (rest.starts_with(':')) range.last = read_cell_name(rest.substr(1), rest);
  const auto or_all = [](std::size_t& value, std::size_t all) { value = value ? value : all; };
  const bool has_columns = range.first.column > 0 && range.last.column > 0;
  or_all(range.first.row, 1);
  or_all(range.last.row, most_sheet_rows);
  if (!rest.empty() || !has_columns || range.last.column > most_sheet_columns ||
      range.last.row > most_sheet_rows || range.first.column > range.last.column ||
      range.first.row > range.last.row)
    throw InputError(fmt::format("{}: '{}' is not a range of a sheet; write one like B3:F20 or B:F",
                                 source, text));
  return range;
}

}  // namespace wearwell
