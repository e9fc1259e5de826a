#pragma once

#include "wearwell/input/columns.h"
#include "wearwell/models/fatigue/life_test.h"

namespace wearwell {

/// How a test ended, of a cell: "failure", "runout", ... or their codes. Throws InputError.
fatigue::Outcome read_outcome(const Table& table, const ColumnChoice& choice, std::size_t row);

}  // namespace wearwell
