#pragma once

#include <cstddef>
#include <vector>

namespace wearwell {

/// How many items of each row the check of fit judges; `counts` may be empty for one each. Where a row stands for very
/// many, the same `share` of all rows, spread evenly over them: fewer of one alone would shift the distribution. `sampled`:
/// the number of rows that are judged at most.
std::vector<int> judged_counts(const std::vector<int>& counts, std::size_t rows,
                               std::size_t sampled, double& share);

}  // namespace wearwell
