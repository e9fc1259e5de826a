#pragma once

#include <span>
#include <vector>

namespace wearwell::prognosis {

/// Quantiles of weighted values as those of WeightedLives (to rounding), at a fraction of the cost:
/// sorts only the values around each. `at`: probabilities between 0 and 1. NaN if no value has
/// weight.
std::vector<double> weighted_quantiles(std::span<const double> value,
                                       std::span<const double> weight, std::span<const double> at);

}  // namespace wearwell::prognosis
