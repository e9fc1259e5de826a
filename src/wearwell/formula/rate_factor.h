#pragma once

#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// The same rate as `factor * shape`: the factor holds all that is neither the state nor the axis as far as it can
/// be taken out, so that along one path of the shape all rates run that differ by their factor alone, each at its
/// own pace. A node of `graph`, to which what is new is added; `rate` itself where there is no factor.
int factored_rate(Graph& graph, int rate);

/// The parts of such a node: -1 for a factor of 1.
struct RateParts {
  int factor = -1, shape = -1;
};
RateParts rate_parts(const Graph& graph, int rate);

}  // namespace wearwell::formula
