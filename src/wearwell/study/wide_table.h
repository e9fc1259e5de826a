#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// A table with a column for each unit: "Hours, P1, P2, P3", with one reading of each unit in a row.
struct WideTable {
  std::string along;               ///< heading of the column that all share
  std::vector<std::string> units;  ///< headings of the others
  /// The SELECT over `data` that gives a row to each reading: `along`, "unit" and "value", with their units in the
  /// headings.
  std::string sql;
};

/// Recognized where all columns of numbers but one are called alike, by a word for units (study/role_words.h), by up to three
/// letters or by nothing, each with a number or a letter of its own behind, and state the same unit, if any; and the other one is
/// a time, a distance or a number of cycles. At least three units.
std::optional<WideTable> wide_table(const Table& table);

}  // namespace wearwell
