#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"

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

/// The chosen column's values, SI.
inline std::vector<double> si_numbers(const Table& table, const ColumnChoice& choice) {
  return si_numbers(table, choice.column, choice.unit);
}

/// Throws InputError unless `good`: "FILE, row 3, column 'volume': -1 must be ALLOWED".
void require(bool good, const Table& table, const ColumnChoice& choice, std::size_t row,
             const char* allowed);

}  // namespace wearwell
