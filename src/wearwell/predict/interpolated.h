#pragma once

#include <optional>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell {

struct Interpolated {
  QuantityDistribution distribution;
  double misfit;  ///< relative root mean square misfit at the validation points
};

/// The distributions of expensive, smooth functions of the parameters that are known at few points
/// of a posterior: `at_few` has a row per point and a column per quantity. Over the whole posterior
/// with its cells, each is a least-squares polynomial (Hermite polynomials of the whitened
/// parameters). This removes the noise that few points leave in quantiles. Empty for a quantity
/// with a validation misfit above 3 % (root mean square), and for a posterior without cells.
std::vector<std::optional<Interpolated>> interpolated(const WeightedDraws& draws,
                                                      const ThinnedPosterior& few,
                                                      const Points& at_few);

}  // namespace wearwell
