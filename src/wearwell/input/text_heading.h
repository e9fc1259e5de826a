#pragma once

#include <string>
#include <vector>

#include "wearwell/input/table_file.h"
#include "wearwell/input/table_settings.h"

namespace wearwell {

/// Where a text has its headings, and what separates its columns.
struct TextHeading {
  char delimiter = ',';
  std::size_t line = 1;
  std::vector<std::string> names;  ///< without blanks around them; an empty one has no heading
};

/// Throws InputError: no heading, two columns of one name, columns that can be separated in two ways.
TextHeading find_heading(const TableFile& file, const TableSettings& settings, Encoding encoding);

}  // namespace wearwell
