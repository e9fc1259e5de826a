#pragma once

#include <vector>

#include "wearwell/formula/graph.h"
#include "wearwell/formula/program.h"

namespace wearwell::formula {

/// Expressions as written, before compilation to a tape.
struct WrittenGraph {
  Graph graph;
  std::vector<int> roots;  ///< of `wanted`
};

/// Throws InputError like `compile`.
WrittenGraph written_graph(const std::vector<Line>& law, const std::vector<Wanted>& wanted,
                           const Symbols& symbols);

}  // namespace wearwell::formula
