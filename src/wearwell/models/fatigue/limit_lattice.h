#pragma once

#include <optional>

#include "wearwell/models/fatigue/random_limit.h"

namespace wearwell::fatigue {

/// `log_probability_and_slopes` by the trapezoidal rule on nodes whose logarithms are in a table
/// (on the line of limit_integral.h), or about a narrow distribution by series: a node costs one
/// exponential. For a run-out or a left-censored life the narrower of the two distributions enters
/// as density, the other as cdf (integration by parts). Empty if the rule is not accurate, which
/// its nodes show, and for intervals.
std::optional<LimitedLifeSlopes> on_lattice(const LimitedLife<double>& item, Outcome outcome,
                                            double at);

}  // namespace wearwell::fatigue
