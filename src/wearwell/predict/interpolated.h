#pragma once

#include <optional>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell {

struct Interpolated {
  QuantityDistribution distribution;
  double
      misfit;  ///< of the polynomial at points that it was not fitted to, relative, root mean square
};

/// The distributions of numbers that are smooth in the parameters and expensive, known at few of a posterior's points:
/// `at_few` has a row a point and a column a number. Over the whole posterior, with its cells, they are polynomials fitted to these by
/// least squares, in Hermite polynomials of the whitened parameters. Few points alone leave the noise of their number in a quantile.
/// None of a number whose polynomial misses points that it was not fitted to by more than 3 % of its size, in the mean square, and where the
/// posterior has no cells.
std::vector<std::optional<Interpolated>> interpolated(const WeightedDraws& draws,
                                                      const ThinnedPosterior& few,
                                                      const Points& at_few);

}  // namespace wearwell
