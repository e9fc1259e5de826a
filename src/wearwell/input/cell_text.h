#pragma once

#include <optional>
#include <string_view>

namespace wearwell {

/// A number in a cell with what people write around it: "<0.5", ">5.000.000", "12 mm", "≤0,05 mm".
/// "<LOD" states no number.
struct CellText {
  char sign = 0;            ///< '<' or '>' of a limit; 0 of a value
  std::string_view number;  ///< "0.5"; empty where the cell does not state its limit
  std::string_view unit;    ///< "mm"; empty where there is none
};

/// Nothing where the cell holds something else, or a number alone.
std::optional<CellText> cell_text(std::string_view cell);

/// Whether a cell says that there is no value: "NA", "n/a", "#NV", "-".
bool is_missing_mark(std::string_view cell);

}  // namespace wearwell
