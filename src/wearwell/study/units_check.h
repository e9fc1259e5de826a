#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/infer/check.h"

namespace wearwell {

/// What was read for one quantity of the data, row by row.
struct DataColumn {
  std::string name;            ///< as the study file names it: "force"
  std::string si;              ///< its SI unit, which says what it is
  Unit unit;                   ///< in which it was written
  std::vector<double> values;  ///< SI
  bool condition = false;  ///< of the test, and not what grows with it, so of one size in all rows
  bool endless =
      false;  ///< a length may be a way, how far something slid: no size of a machine bounds it
};

/// Whether units were mistaken, by rules that hold for any machine (docs/reference/units.md): a count below
/// one, a size that no machine has, rows of one column that differ by hundreds. Nothing when there
/// is nothing to say, else a warning named "units".
std::optional<Check> units_check(const std::vector<DataColumn>& columns);

}  // namespace wearwell
