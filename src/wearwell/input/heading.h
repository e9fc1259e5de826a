#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "wearwell/base/unit.h"

namespace wearwell {

/// A heading split into name and unit: "volume [mm³]", "volume [mm³] (left)", "volume (mm³)",
/// "volume / mm³", "volume in mm³", "volume, mm³", "volume_mm3".
struct Heading {
  std::string name;  ///< "volume"
  std::string unit;  ///< "mm³"; empty without a unit
  /// Whether the text must be a unit: it is in square brackets, or has a factor as in "life
  /// (x1000)". The other forms are ambiguous, as in "life (N)" or "stress_a".
  bool certain = false;
  bool suffix = false;  ///< the unit follows '_', where an index is possible too
};
/// `si`: the dimension that an ambiguous unit must have; empty for any.
Heading read_heading(std::string_view heading, std::string_view si);

/// Whether a text at the end of a heading is a unit of the dimension of `si` (any if empty); `suffix`: behind '_'. A number there is a
/// factor, "cycles (1000)", or the place of a column among others: "film (2)", "film_2".
bool is_unit_of_heading(const std::string& text, std::string_view si, bool suffix = false);

/// Whether a cell may be the unit of its column: "mm", "[mm]", "(mm)".
bool is_unit_cell(std::string_view cell);

/// The unit without brackets; "1" for "-".
std::string bare_unit(std::string_view text);

}  // namespace wearwell
