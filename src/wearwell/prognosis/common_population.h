#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/prognosis/known_lives.h"

namespace wearwell::prognosis {

/// The populations that units of a fleet may share, and what each unit comes to in each of them. Given the population units
/// are independent, so that a number of them is a mixture of Poisson-binomial laws (`how_many`), exact but for the points that stand
/// for the population's posterior. Its weights are those of the study times the likelihoods of what all units have shown since.
struct CommonPopulation {
  /// Of populations; sum to 1. One: nothing of what units share is at hand, `why` says what, and units count as independent.
  std::vector<double> weight = {1};
  double effective = 1;  ///< 1 / sum of squares of the weights
  std::string why = {};  ///< units are counted as independent
  bool outgrown =
      false;  ///< because readings since the study say more of the population than its points carry
  /// By population, by moment, by unit: the probability that its limit is behind it then.
  std::vector<std::vector<std::vector<double>>> failed;
};

/// Of moments from now on, SI.
CommonPopulation in_common(const KnownLives& lives, std::span<const KnownUnit* const> units,
                           std::span<const double> after);

}  // namespace wearwell::prognosis
