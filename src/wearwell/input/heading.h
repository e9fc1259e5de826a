#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "wearwell/base/unit.h"

namespace wearwell {

/// A heading and the unit that stands in it: "volume [mm³]", "volume [mm³] (left)", "volume (mm³)",
/// "volume / mm³", "volume in mm³", "volume, mm³", "volume_mm3".
struct Heading {
  std::string name;  ///< "volume"
  std::string unit;  ///< "mm³"; empty where there is none
  /// Whether the heading says that it is a unit, by square brackets or, as in "life (x1000)", by a
  /// factor: it is one or an error. The other ways may mean something else, as in "life (N)" or
  /// "stress_a".
  bool certain = false;
  bool suffix = false;  ///< the unit stands behind '_', where an index may stand as well
};
/// `si`: the dimension that a unit in an uncertain place must have to be one; empty for any unit.
Heading read_heading(std::string_view heading, std::string_view si);

/// Whether a cell can be the unit of its column: "mm", "[mm]", "(mm)".
bool is_unit_cell(std::string_view cell);

/// Without brackets around it; "1" for "-".
std::string bare_unit(std::string_view text);

}  // namespace wearwell
