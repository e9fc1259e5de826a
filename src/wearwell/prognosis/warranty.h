#pragma once

#include "wearwell/prognosis/replacement.h"

namespace wearwell::prognosis {

/// The length of a warranty by the share of new units that fail within it.
struct Warranty {
  double share = 0;   ///< of units sold, 0 to 1
  double length = 0;  ///< at which the expected share is `share`, SI
  double sure = 0;    ///< at which, with probability 95 %, the share is at most that
};

/// The longest warranties with at most this share of claims, 0 < share < 1. Infinite where fewer
/// units ever fail.
Warranty longest_warranty(const PopulationLives& lives, double share);

}  // namespace wearwell::prognosis
