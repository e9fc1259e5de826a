#pragma once

#include <vector>

#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// The expressions `roots` of `from` as they are best computed, in `to`: products are ordered so that
/// what depends on the data alone is one factor and what depends on parameters alone another, a power
/// of data by a parameter uses the logarithm of the data. Returns their nodes in `to`. Values differ
/// by rounding alone.
/// A state whose rate is linear in it becomes a recurrence along `axis`.
std::vector<int> regrouped(const Graph& from, const std::vector<int>& roots, int axis, Graph& to);

}  // namespace wearwell::formula
