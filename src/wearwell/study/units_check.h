#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/infer/check.h"

namespace wearwell {

/// The values of one quantity of the data, row by row.
struct DataColumn {
  std::string name;            ///< its name in the study file: "force"
  std::string si;              ///< its SI unit, which identifies the dimension
  Unit unit;                   ///< the unit of the column
  std::vector<double> values;  ///< SI
  bool condition = false;      ///< a test condition, so of similar size in all rows
  bool endless = false;        ///< a distance, such as a sliding distance, has no upper bound
};

/// Detects mistaken units by rules for any machine (docs/reference/units.md): a count below one, an
/// implausible size, a factor of hundreds within a column. Returns a warning named "units", or
/// nothing.
std::optional<Check> units_check(const std::vector<DataColumn>& columns);

}  // namespace wearwell
