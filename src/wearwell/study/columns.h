#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/study/toml_reader.h"
#include "wearwell/table/table.h"

namespace wearwell {

/// A column that a study names: NAME = "column", or { column = "...", unit = "..." }.
struct ColumnChoice {
  std::string column;
  Unit unit;
};

/// Reads the choice for `name` from a [columns] table; a dimension other than a number or a count needs a unit.
std::optional<ColumnChoice> read_column(const TomlReader& columns, const std::string& name,
                                        const std::string& si);
ColumnChoice required_column(const TomlReader& columns, const std::string& name,
                             const std::string& si);

/// The table that `section` names as its `file`, beside the study, through its `sql` if it has one.
/// Throws InputError at these keys, and as read_table does.
Table read_table(const TomlReader& section, const std::filesystem::path& folder);

/// A file beside the study that must be there. Throws InputError at the key that names it.
std::filesystem::path required_file(const TomlReader& section, const std::string& key,
                                    const std::filesystem::path& folder);

/// The chosen column's values, SI.
inline std::vector<double> si_numbers(const Table& table, const ColumnChoice& choice) {
  return si_numbers(table, choice.column, choice.unit);
}

/// Throws InputError unless `good`: "FILE, row 3, column 'volume': -1 must be ALLOWED".
void require(bool good, const Table& table, const ColumnChoice& choice, std::size_t row,
             const char* allowed);

}  // namespace wearwell
