#pragma once

#include <memory>
#include <optional>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// A surrogate of a posterior with many observations, whose evaluations are expensive and whose
/// posterior is narrow: Chebyshev polynomials of the likelihood about the mode.
struct QuickPosterior {
  std::shared_ptr<const Posterior> posterior;
  double error = 0;  ///< of the log-likelihood, the largest found between the nodes
};

/// Empty with fewer than thirty observations (factors of `LogDensity::pointwise`) unless the
/// density is slow (`LogDensity::is_slow`), with more than three parameters, or if the polynomials
/// are not within 1e-5 of the likelihood where the posterior is relevant. The decision depends on
/// evaluations, not on time. Beyond seven standard deviations the likelihood continues as a
/// parabola, which is compared with the true one; beyond 21 it is the true one. Factors are always
/// true. `whitening` is at the mode of `posterior`.
std::optional<QuickPosterior> surrogate_posterior(const Posterior& posterior,
                                                  const Whitening& whitening);

}  // namespace wearwell
