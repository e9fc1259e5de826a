#pragma once

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

/// Reads the choice for `name` from a [columns] table; a dimension other than "1" needs a unit.
std::optional<ColumnChoice> read_column(const TomlReader& columns, const std::string& name,
                                        const std::string& si);
ColumnChoice required_column(const TomlReader& columns, const std::string& name,
                             const std::string& si);

/// The chosen column's values, SI.
inline std::vector<double> si_numbers(const Table& table, const ColumnChoice& choice) {
  return si_numbers(table, choice.column, choice.unit);
}

}  // namespace wearwell
