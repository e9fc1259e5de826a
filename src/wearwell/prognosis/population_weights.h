#pragma once

#include <span>
#include <vector>

namespace wearwell::prognosis {

/// Weights of populations, given what units have shown.
struct PopulationWeights {
  std::vector<double> weight;  ///< sum to 1
  double effective = 1;        ///< 1 / sum of squares
  /// Whether enough populations carry the weight: 50, or half of what the prior weights have. If
  /// not, the points that represent the population are too few for this evidence.
  bool resolved = true;
};

/// Of prior weights and the log-likelihood of what was seen, by population. Without evidence (all
/// zero) the prior is always resolved.
PopulationWeights weights_given(std::span<const double> prior,
                                std::span<const double> log_likelihood);

}  // namespace wearwell::prognosis
