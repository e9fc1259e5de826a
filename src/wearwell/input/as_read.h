#pragma once

#include <string>

#include "wearwell/input/source.h"

namespace wearwell {

/// The names in `Source::tables` of a section's table as read_table returned it, and of the table
/// before its sql. The study can then be read again without its file; sql and layout settings are
/// already applied. Throws InputError at these keys.
std::string as_read_name(const TomlReader& section);
std::string before_sql_name(const TomlReader& section);

/// The table in memory of a section: read earlier, or passed by the caller; null if it is in a
/// file.
const Table* table_in_memory(const TomlReader& section, const Source& source);

/// Whether every non-empty cell is a number, with the marks of the column.
bool holds_numbers(const Column& column);

/// The result of a query of a table in memory, the same as of a file with this table: column types
/// are detected again. Throws InputError and QueryError like read_table.
Table query_table(const Table& table, const std::string& sql, const QueryLimits& limits = {});

}  // namespace wearwell
