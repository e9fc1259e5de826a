#pragma once

#include <functional>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"

namespace wearwell {

/// The probability between adjacent ascending `edges`, for density curves. Within a quadrature cell
/// the density is linear along the widest axis, with the cell's mean, and constant along the
/// others. This makes adjacent layers of cells continuous, where a constant density (QuantityDistribution)
/// gives steps. Draws are points.
std::vector<double> cell_shares(const WeightedDraws& draws,
                                const std::function<double(const double* x)>& quantity,
                                const std::vector<double>& edges);

}  // namespace wearwell
