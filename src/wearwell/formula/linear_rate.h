#pragma once

#include <optional>

#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// A rate that is constant + slope * state, where neither depends on the state nor on the axis; nodes,
/// -1 for 0.
struct LinearRate {
  int constant = -1, slope = -1;
};

/// The parts of a rate in `graph`, to which they are added; nothing where it is not linear.
std::optional<LinearRate> linear_rate(Graph& graph, int rate);

}  // namespace wearwell::formula
