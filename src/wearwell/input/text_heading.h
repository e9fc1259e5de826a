#pragma once

#include <string>
#include <vector>

#include "wearwell/input/table_file.h"
#include "wearwell/input/table_settings.h"

namespace wearwell {

/// The position of the headings in a text, and the column separator.
struct TextHeading {
  char delimiter = ',';
  std::size_t line = 1;
  std::vector<std::string> names;  ///< trimmed; empty for a column without heading
};

/// Throws InputError: no heading, duplicate column names, ambiguous separator.
TextHeading find_heading(const TableFile& file, const TableSettings& settings, Encoding encoding);

}  // namespace wearwell
