#pragma once

#include <memory>
#include <vector>

#include "wearwell/input/table_file.h"
#include "wearwell/input/text_layout.h"

namespace wearwell {

/// The table of a text as the plainest CSV, in memory: UTF-8, one line of headings, commas, points,
/// and nothing that is no row. Columns that are no numbers, or doubtful ones, stay as they are.
/// `lines` takes the line of each row.
std::unique_ptr<TableFile> rewritten(const TableFile& file, const TextLayout& layout,
                                     std::vector<std::size_t>& lines);

}  // namespace wearwell
