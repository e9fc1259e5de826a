#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "wearwell/models/clutch/cycle_sum.h"

namespace wearwell::clutch {

/// Runs the cycles of a file (columns of read_cycles; CSV, Parquet, JSON) through `sum`, in
/// batches: memory does not grow with the file. `trace`, where there is one, is called with lines of
/// CSV in order, one for every `every`-th cycle of the file: plate, cycle, volume, sd and 95 %
/// interval by scatter, the same by all that is uncertain (where `sum` has replicates), inputs outside the range of validity ("skipped" for a cycle that was). `threads`: 0 for all. Returns the number of cycles. Throws InputError naming file,
/// row and column; then `sum` holds part of the file.
std::size_t sum_cycles(const std::filesystem::path& file, CycleSum& sum,
                       const std::function<void(std::string_view)>& trace = {},
                       std::size_t every = 1, int threads = 0);

/// Cycles as CycleSum takes them.
CycleColumns columns_of(const std::vector<Cycle>& cycles, std::size_t first, std::size_t last);

}  // namespace wearwell::clutch
