#pragma once

#include <memory>
#include <vector>

#include "wearwell/input/table_file.h"
#include "wearwell/input/text_layout.h"

namespace wearwell {

/// The table of a text as standard CSV in memory: UTF-8, one line of headings, commas, decimal
/// points, only data rows. Columns of text or ambiguous numbers are unchanged. `lines` receives the
/// line of each row.
std::unique_ptr<TableFile> rewritten(const TableFile& file, const TextLayout& layout,
                                     std::vector<std::size_t>& lines);

}  // namespace wearwell
