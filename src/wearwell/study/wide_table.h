#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// A wide table: a column for each unit ("Hours, P1, P2, P3"), and one reading of each unit in a
/// row.
struct WideTable {
  std::string along;               ///< heading of the shared column
  std::vector<std::string> units;  ///< headings of the others
  /// The SELECT over `data` that makes a row of each reading: `along`, "unit" and "value", with
  /// their units in the headings.
  std::string sql;
};

/// Recognizes a wide table. All number columns but one share a name and the same unit, if any. The
/// name is a word for units (study/role_words.h), up to three letters, or empty, followed by a
/// distinct number or letter. The other column is a time, a distance or a number of cycles. There
/// are at least three units.
std::optional<WideTable> wide_table(const Table& table);

}  // namespace wearwell
