#pragma once

#include <cstddef>
#include <optional>

#include "wearwell/input/table.h"

namespace wearwell {

/// What `cell_value` gives; none where it refuses the cell. A refusal with its message takes a thousand
/// times as long.
std::optional<CellValue> readable_cell(const Table& table, const Column& column, std::size_t index);

}  // namespace wearwell
