#pragma once

#include <string>
#include <vector>

#include "wearwell/study/units_check.h"

namespace wearwell {

/// What was read of each column, in the units in which it was written: how many rows, the smallest
/// value, the median and the largest, and what one unit was taken to be. A table of lines, indented by
/// two; empty without columns.
std::string columns_text(const std::vector<DataColumn>& columns);

}  // namespace wearwell
