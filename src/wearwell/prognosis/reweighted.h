#pragma once

#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"

namespace wearwell::prognosis {

/// A posterior moved by new data without laying its nodes anew: each weight times the ratio of the two densities there.
struct Reweighted {
  WeightedDraws draws;
  double effective = 0;  ///< 1 / sum of squares of the weights
  double kept =
      0;  ///< that over what it was before: how much of the posterior the nodes still resolve
};
Reweighted reweighted(const WeightedDraws& draws, const Posterior& before, const Posterior& after);

/// Whether lives may be read off it (measured in docs/how-to/state.md).
bool resolves(const Reweighted& moved);

}  // namespace wearwell::prognosis
