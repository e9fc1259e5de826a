#pragma once

#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// Splits a rate into `factor * shape`. The factor collects what depends on neither the state nor
/// the axis, so rates with different factors share one trajectory of the shape at different speeds.
/// Returns a node of `graph` (new nodes are added), or `rate` itself without a factor.
int factored_rate(Graph& graph, int rate);

/// The parts of such a node; -1 for a factor of 1.
struct RateParts {
  int factor = -1, shape = -1;
};
RateParts rate_parts(const Graph& graph, int rate);

}  // namespace wearwell::formula
