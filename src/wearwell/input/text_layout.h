#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/number_text.h"
#include "wearwell/input/table_file.h"
#include "wearwell/input/table_settings.h"

namespace wearwell {

/// One column of a text, after all of it was seen.
struct TextColumn {
  std::string name;       ///< its heading; "column3" where there is none
  std::string unit;       ///< from a row of units, or from the cells
  bool is_number = true;  ///< every cell that is not empty is one, or says that there is none
  bool unit_in_cells = false;
  NumberMarks marks;
  std::string doubt;  ///< "row 1, column 'life': ...": why its numbers cannot be read
};

/// How a text holds a table: as a study says, or as the text itself shows.
struct TextLayout {
  Encoding encoding = Encoding::utf8;
  char delimiter = ',';
  std::string comment;           ///< with which lines begin that are left out
  std::size_t heading_line = 1;  ///< where the record of the headings begins
  bool units_row = false;
  std::optional<std::size_t> summary_line = {};  ///< from there on rows are means and sums
  std::vector<TextColumn> columns;
  /// Whether DuckDB can read the file as it stands.
  bool plain = true;
  // What was left out, for people.
  std::size_t comments = 0, empty_rows = 0;
  std::vector<std::string>
      notes;                  ///< what else was seen: "column 'V': 2 cells without a value ('NA')"
  std::string decimal_marks;  ///< that numbers have: "", ".", "," or both
  std::string thousands_marks;  ///< likewise
};

/// Finds it out. Throws InputError naming the line: no text, no heading, two columns of one name, columns
/// that can be separated in two ways, a line with more or fewer values than the heading. `whole`:
/// looks at every line; else stops where nothing that comes could change what was found.
TextLayout find_layout(const TableFile& file, const TableSettings& settings, bool whole = false);

/// "semicolons, decimal comma, thousands point, cp1252, headings in line 5"; of a sheet its name.
std::string description(const TextLayout& layout, const std::string& sheet);

}  // namespace wearwell
