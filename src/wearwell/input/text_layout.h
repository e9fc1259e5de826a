#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/number_text.h"
#include "wearwell/input/table_file.h"
#include "wearwell/input/table_settings.h"

namespace wearwell {

/// One column of a text, after the survey.
struct TextColumn {
  std::string name;       ///< its heading; "column3" without a heading
  std::string unit;       ///< from a units row or from the cells
  bool is_number = true;  ///< every non-empty cell is a number or marks a missing value
  bool unit_in_cells = false;
  NumberMarks marks;
  std::string doubt;  ///< "row 1, column 'life': ...": why its numbers cannot be read
};

/// The layout of a table in a text: stated by the study, or detected.
struct TextLayout {
  Encoding encoding = Encoding::utf8;
  char delimiter = ',';
  std::string comment;           ///< prefix of omitted lines
  std::size_t heading_line = 1;  ///< line of the heading record
  bool units_row = false;
  std::optional<std::size_t> summary_line = {};  ///< first row of means and sums
  std::vector<TextColumn> columns;
  /// Whether DuckDB can read the file directly.
  bool plain = true;
  // Numbers of omitted rows, for the description.
  std::size_t comments = 0, empty_rows = 0;
  std::vector<std::string> notes;  ///< remarks: "column 'V': 2 cells without a value ('NA')"
  std::string decimal_marks;       ///< in the numbers: "", ".", "," or both
  std::string thousands_marks;     ///< likewise
};

/// Detects the layout. Throws InputError that names the line: not a text, no heading, duplicate
/// column names, ambiguous separator, a line with more or fewer values than the heading. `whole`
/// inspects every line; otherwise it stops as soon as later lines cannot change the result.
TextLayout find_layout(const TableFile& file, const TableSettings& settings, bool whole = false);

/// "semicolons, decimal comma, thousands point, cp1252, headings in line 5"; for a sheet its name.
std::string description(const TextLayout& layout, const std::string& sheet);

}  // namespace wearwell
