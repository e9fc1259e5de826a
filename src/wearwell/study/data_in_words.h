#pragma once

#include <string>
#include <vector>

#include "wearwell/study/units_check.h"

namespace wearwell {

/// Describes each column in its own units: number of rows, minimum, median, maximum, and the value
/// of one unit in SI. A table of lines, indented by two; empty without columns.
std::string columns_text(const std::vector<DataColumn>& columns);

}  // namespace wearwell
