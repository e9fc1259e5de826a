#pragma once

#include <string>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// The number in each row, in the unit of the table; NaN where there is none.
std::vector<double> numbers_of(const Table& table, const Column& column);
/// Those that are there.
std::vector<double> values_of(const Table& table, const Column& column);

/// What its cells hold, each once, without empty ones, in order of appearance.
std::vector<std::string> kinds_of(const Table& table, const Column& column);

/// Whether not all of its cells are alike; numbers by more than rounding.
bool differs(const Table& table, const Column& column);

/// Whether its cells name groups of rows: more than one kind, and fewer than rows.
bool repeats(const Table& table, const Column& column);

}  // namespace wearwell
