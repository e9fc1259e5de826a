#pragma once

#include "wearwell/input/columns.h"
#include "wearwell/input/life_status.h"
#include "wearwell/models/fatigue/life_test.h"

namespace wearwell {

/// How a test ended. Throws InputError that names its cell.
fatigue::Outcome read_outcome(const Table& table, const LifeStatus& status, std::size_t row);

/// How a test ended by its status or by its life, which may be a limit (">5000", `seen`); a failure where neither says
/// it. Throws InputError where they contradict.
fatigue::Outcome read_outcome(const Table& table, const std::optional<LifeStatus>& status,
                              const ColumnChoice& life, Censoring seen, std::size_t row);

/// Where the interval of a test ends [cycles]; 0 of a test that is none, whose cell is empty or repeats what its life says.
/// Another number there has two readings. Throws InputError.
double read_interval_end(const Table& table, const ColumnChoice& until, std::size_t row,
                         const fatigue::LifeTest& test);

}  // namespace wearwell
