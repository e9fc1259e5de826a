#pragma once

#include <cstddef>
#include <optional>

#include "wearwell/prognosis/known_lives.h"

namespace wearwell::prognosis {

/// The length of a warranty by the share of new units that fail within it.
struct Warranty {
  double share = 0;   ///< of units sold, 0 to 1
  double length = 0;  ///< at which the expected share is `share`, SI
  double sure = 0;    ///< at which, with probability 95 %, the share is at most that
  /// Number of populations that `sure` rests on; 0: it is over the whole posterior.
  std::size_t populations = 0;
  /// Relative error of `sure`: of the quantile of so many populations, as if drawn at random, or the numerical error
  /// of the fit.
  std::optional<double> error = {};
};

/// The longest warranties with at most this share of claims, 0 < share < 1. Infinite where fewer
/// units ever fail. As the fit's B-life where the lives are of one, else from populations.
Warranty longest_warranty(const KnownLives& lives, double share);
Warranty longest_warranty(const PopulationLives& lives, double share);

}  // namespace wearwell::prognosis
