#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "wearwell/input/table.h"

namespace wearwell::prognosis {

/// A column of a table of units, such as of their lives or ages; null if it is missing.
const Column* optional_column(const Table& table, std::string_view name);

/// Throws InputError that names the first column that is none of these (some may be null), and
/// `names`, those that are known.
void refuse_other_columns(const Table& table, std::initializer_list<const Column*> known,
                          const char* names);

/// A cell as text; empty for an empty cell or a null column.
std::string cell_text(const Column* column, std::size_t row);

/// The unit in a column's heading; empty without one.
std::string heading_unit(const Column& column);

}  // namespace wearwell::prognosis
