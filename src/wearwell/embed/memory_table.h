#pragma once

#include <map>
#include <string>

#include "wearwell/input/table.h"

namespace wearwell::embed {

/// Appends a column. Throws InputError if its number of rows differs from the earlier ones.
void add_column(Table& table, Column column);

/// Throws InputError if it has no columns, no rows, or two columns with one name.
void refuse_no_table(const Table& table);

/// Units of columns by heading or name. Throws InputError that names the nearest if there is no
/// such column.
void add_units(Table& table, const std::map<std::string, std::string>& units);

}  // namespace wearwell::embed
