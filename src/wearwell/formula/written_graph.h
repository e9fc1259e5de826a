#pragma once

#include <vector>

#include "wearwell/formula/graph.h"
#include "wearwell/formula/program.h"

namespace wearwell::formula {

/// Expressions as they are written, before they are made a tape.
struct WrittenGraph {
  Graph graph;
  std::vector<int> roots;  ///< of `wanted`
};

/// Throws InputError as `compile` does.
WrittenGraph written_graph(const std::vector<Line>& law, const std::vector<Wanted>& wanted,
                           const Symbols& symbols);

}  // namespace wearwell::formula
