#pragma once

#include "wearwell/input/columns.h"
#include "wearwell/input/life_status.h"
#include "wearwell/models/fatigue/life_test.h"

namespace wearwell {

/// The outcome of a test. Throws InputError that names its cell.
fatigue::Outcome read_outcome(const Table& table, const LifeStatus& status, std::size_t row);

/// The outcome of a test by its status or by its life, which may be a limit (">5000", `seen`); a
/// failure by default. Throws InputError if they contradict.
fatigue::Outcome read_outcome(const Table& table, const std::optional<LifeStatus>& status,
                              const ColumnChoice& life, Censoring seen, std::size_t row);

/// The end of the interval of a test [cycles]; 0 for other tests, whose cell is empty or repeats
/// the life. Another value there is ambiguous. Throws InputError.
double read_interval_end(const Table& table, const ColumnChoice& until, std::size_t row,
                         const fatigue::LifeTest& test);

}  // namespace wearwell
