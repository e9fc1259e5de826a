#pragma once

#include <string>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// The number in each row, in the unit of the table; NaN for a missing value.
std::vector<double> numbers_of(const Table& table, const Column& column);
/// The values that are present.
std::vector<double> values_of(const Table& table, const Column& column);

/// The distinct non-empty cells, in order of appearance.
std::vector<std::string> kinds_of(const Table& table, const Column& column);

/// Whether some cells are lower limits such as ">5000", which mean a right-censored life.
bool has_open_ends(const Column& column);

/// Whether its cells vary; numbers by more than rounding.
bool differs(const Table& table, const Column& column);

/// Whether its cells name groups of rows: more than one value, and fewer values than rows.
bool repeats(const Table& table, const Column& column);

}  // namespace wearwell
