#pragma once

#include <optional>
#include <string_view>

namespace wearwell {

/// A number in a cell with its sign of a limit and its unit: "<0.5", ">5.000.000", "12 mm", "≤0,05
/// mm". "<LOD" states no number.
struct CellText {
  char sign = 0;            ///< '<' or '>' for a limit; 0 for a value
  std::string_view number;  ///< "0.5"; empty if the cell does not state its limit
  std::string_view unit;    ///< "mm"; empty without a unit
};

/// Empty if the cell holds anything else, or only a number.
std::optional<CellText> cell_text(std::string_view cell);

/// Whether a cell is empty or only blanks, as some programs write an empty one.
bool is_blank(std::string_view cell);

/// Whether a cell marks a missing value: "NA", "n/a", "#NV", "-".
bool is_missing_mark(std::string_view cell);

/// Whether a cell has no value: it is blank or marks a missing one.
bool is_absent(std::string_view cell);

}  // namespace wearwell
