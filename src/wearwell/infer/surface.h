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

/// None where observations are fewer than thirty (factors of `LogDensity::pointwise`; with four parameters fewer than 20,000, as some thousand evaluations
/// have to pay) and none of a slow density (`LogDensity::is_slow`), parameters more than four (of a slow one three), or where the polynomials are not within 1e-5 of the likelihood wherever there is posterior; all that is
/// decided by evaluations alone, not by time. Beyond seven standard deviations the likelihood goes on as a parabola,
/// and is held against the true one there; beyond 21 it is the true one. Factors are always true.
/// `whitening` is at the mode of `posterior`.
std::optional<QuickPosterior> surrogate_posterior(const Posterior& posterior,
                                                  const Whitening& whitening);

}  // namespace wearwell
