#pragma once

#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// How an expression depends on the parameters given by row (Scope::per_row), as far as its form says. Cases
/// (`where`, `max`) whose conditions do not depend on them leave it what its branches are.
enum class ByRowDegree {
  none,    ///< not at all
  linear,  ///< a sum of what does not depend on them and of multiples of single ones
  other,   ///< in another way, or the form does not say
};

ByRowDegree by_row_degree(const Graph& graph, int root);

}  // namespace wearwell::formula
