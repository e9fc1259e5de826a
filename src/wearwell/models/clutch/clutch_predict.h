#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "wearwell/models/clutch/cycle_sum.h"

namespace wearwell::clutch {

/// Runs the cycles of a file (columns of read_cycles; CSV, Parquet, JSON) through `sum`, in
/// batches, with constant memory. `trace`, if given, is called with lines of CSV in order, one for
/// every `every`-th cycle of the file: plate, cycle, volume, sd and 95 % interval by scatter, the
/// same by the total uncertainty (if `sum` has replicates), inputs outside the calibrated range
/// ("skipped" for a skipped cycle). `threads`: 0 for all. Returns the number of cycles. Throws
/// InputError naming file, row and column; then `sum` holds part of the file.
std::size_t sum_cycles(const std::filesystem::path& file, CycleSum& sum,
                       const std::function<void(std::string_view)>& trace = {},
                       std::size_t every = 1, int threads = 0);

/// Cycles in the form of CycleSum.
CycleColumns columns_of(const std::vector<Cycle>& cycles, std::size_t first, std::size_t last);

}  // namespace wearwell::clutch
