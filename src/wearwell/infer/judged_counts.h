#pragma once

#include <cstddef>
#include <vector>

#include "wearwell/base/rng.h"

namespace wearwell {

/// How many items of each row the check of fit judges; `counts` may be empty for one each. Where a row stands for very
/// many, the same `share` of all rows, spread evenly over them: fewer of one alone would shift the distribution. `sampled`:
/// the number of rows that are judged at most.
std::vector<int> judged_counts(const std::vector<int>& counts, std::size_t rows,
                               std::size_t sampled, double& share);

/// The row of each judged item, in order. Of more rows than `most`, the same share of rows of one item, by lot, and of the items
/// in rows of several: rows of many items that are drawn whole would scatter too much under a correct model.
std::vector<std::size_t> judged_items(const std::vector<int>& counts, std::size_t most,
                                      const Rng& lots);

}  // namespace wearwell
