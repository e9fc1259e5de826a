#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/prognosis/known_lives.h"

namespace wearwell::prognosis {

/// The populations that units of a fleet may share, and the failure probabilities of each unit in
/// each. Given the population units are independent, so a count of failures is a mixture of
/// Poisson-binomial distributions (`how_many`), exact except for the points that represent the
/// population's posterior. The weights are those of the study times the likelihoods of all readings
/// since.
struct CommonPopulation {
  /// Of populations; sum to 1. A single weight: the shared part is not available, `why` gives the
  /// reason, and units count as independent.
  std::vector<double> weight = {1};
  double effective = 1;  ///< 1 / sum of squares of the weights
  std::string why = {};  ///< reason why units count as independent
  bool outgrown =
      /// the readings since the study are more informative than the population's points resolve
      false;
  /// By population, by time, by unit: the probability that it has reached its threshold by then.
  std::vector<std::vector<std::vector<double>>> failed;
};

/// Of times from now on, SI.
CommonPopulation in_common(const KnownLives& lives, std::span<const KnownUnit* const> units,
                           std::span<const double> after);

}  // namespace wearwell::prognosis
