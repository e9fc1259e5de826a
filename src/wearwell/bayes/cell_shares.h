#pragma once

#include <functional>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"

namespace wearwell {

/// The probability that a number lies between each two neighbours of ascending `edges`, for curves of its density:
/// each cell of a quadrature is spread along its widest axis by a straight line that has its mean, and evenly
/// along all others. Layers of cells fit together so, where spreading them evenly (Distribution) makes a
/// stair of what falls. Draws are points.
std::vector<double> cell_shares(const WeightedDraws& draws,
                                const std::function<double(const double* x)>& quantity,
                                const std::vector<double>& edges);

}  // namespace wearwell
