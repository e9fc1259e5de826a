#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "wearwell/input/spreadsheet_cell.h"

namespace wearwell {

inline constexpr std::size_t most_sheet_columns = 16'384, most_sheet_rows = 1'048'576;

/// A non-empty cell.
struct SheetCell {
  std::size_t column = 0;
  std::string text;
  bool is_text = false;  ///< not a number, date or truth value
};

struct SheetRow {
  std::size_t number = 0;
  bool hidden = false;
  std::vector<SheetCell> cells;  ///< by column
};

/// A range of a sheet, both ends included.
struct SheetRange {
  CellName first{1, 1}, last{most_sheet_columns, most_sheet_rows};
};
/// Reads "B3:F20" or "B:F". `source` is the file, for messages. Throws InputError.
SheetRange read_sheet_range(const std::string& text, const std::string& source);

}  // namespace wearwell
