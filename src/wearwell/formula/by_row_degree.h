#pragma once

#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// How an expression depends on the parameters given by row (Scope::per_row), judged from its form.
/// For cases (`where`, `max`) whose conditions do not depend on them, the branches decide.
enum class ByRowDegree {
  none,    ///< not at all
  linear,  ///< a sum of terms independent of them and of multiples of single ones
  other,   ///< another dependence, or unknown from the form
};

ByRowDegree by_row_degree(const Graph& graph, int root);

}  // namespace wearwell::formula
