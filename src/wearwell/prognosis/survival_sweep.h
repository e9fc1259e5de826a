#pragma once

#include <span>
#include <vector>

#include "wearwell/prognosis/replacement.h"

namespace wearwell::prognosis {

/// PopulationLives::survival at many places, which ascend: one pass through the points of each
/// population, in place of a search for each place.
std::vector<double> survivals(const PopulationLives& lives, std::span<const double> ascending);

}  // namespace wearwell::prognosis
