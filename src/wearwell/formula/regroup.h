#pragma once

#include <vector>

#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// Rewrites the expressions `roots` of `from` for fast evaluation, in `to`: products are reordered
/// so that data-only and parameter-only factors are separate, and a power of data by a parameter
/// uses the logarithm of the data. Returns their nodes in `to`. Values change only by rounding. A
/// state whose rate is linear in it becomes a recurrence along `axis`.
std::vector<int> regrouped(const Graph& from, const std::vector<int>& roots, int axis, Graph& to);

}  // namespace wearwell::formula
