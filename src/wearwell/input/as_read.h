#pragma once

#include <string>

#include "wearwell/input/source.h"

namespace wearwell {

/// The names under which `Source::tables` holds what read_table once gave for a section of a study, so that it is
/// read again without its file: as it was read, its sql and its way of writing done with; and what its sql was
/// asked of. Throws InputError at these keys.
std::string as_read_name(const TomlReader& section);
std::string before_sql_name(const TomlReader& section);

/// The table in memory of a section: as it was read once, or as it was handed over; null where it is in a file.
const Table* table_in_memory(const TomlReader& section, const Source& source);

/// Whether every cell that is not empty is a number, with the marks of the column.
bool holds_numbers(const Column& column);

/// What a query gives of a table in memory, as of a file that holds it: types are found anew in its cells. Throws
/// InputError and QueryError as read_table does.
Table query_table(const Table& table, const std::string& sql, const QueryLimits& limits = {});

}  // namespace wearwell
