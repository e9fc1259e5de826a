#pragma once

#include <optional>

#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// A rate constant + slope * state whose parts do not depend on the state or the axis; nodes, -1
/// for 0.
struct LinearRate {
  int constant = -1, slope = -1;
};

/// Adds the parts of a rate to `graph`; empty if it is not linear.
std::optional<LinearRate> linear_rate(Graph& graph, int rate);

}  // namespace wearwell::formula
