#pragma once

#include <optional>

#include "wearwell/models/fatigue/random_limit.h"

namespace wearwell::fatigue {

/// `log_probability_and_slopes` by the trapezoidal rule on nodes whose logarithms stand in a table (on
/// the line of limit_integral.h), or about a narrow law by series: a node costs an exponential. Of
/// a run-out or a left-censored life the narrower of the two laws is the density, the other the
/// distribution function (integration by parts). None where the rule does not reach, which its
/// nodes tell, and for intervals.
std::optional<LimitedLifeSlopes> on_lattice(const LimitedLife<double>& item, Outcome outcome,
                                            double at);

}  // namespace wearwell::fatigue
