#pragma once

#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"

namespace wearwell::prognosis {

/// A posterior updated by new data with fixed nodes: each weight times the ratio of the two
/// densities there.
struct Reweighted {
  WeightedDraws draws;
  double effective = 0;  ///< 1 / sum of squares of the weights
  double kept = 0;  ///< that over its earlier value: how well the nodes still resolve the posterior
};
Reweighted reweighted(const WeightedDraws& draws, const Posterior& before, const Posterior& after);

/// Whether lives may be computed from it (measured in docs/how-to/state.md).
bool resolves(const Reweighted& moved);

}  // namespace wearwell::prognosis
