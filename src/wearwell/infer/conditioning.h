#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/stage.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// Checks whether double precision suffices for this posterior. It does not if a parameter spans
/// fewer than ten thousand adjacent doubles (its scatter went to zero, or the data agree to their
/// last digits), or if cancellation leaves noise above a thousandth in the log density. `points`
/// are of the posterior; the noise is measured about the whitening's center, by eighth-order
/// differences, in which smooth functions vanish (Hamming's table; More and Wild 2011).
std::vector<StageDiagnostic> digits(const Posterior& posterior, const Whitening& whitening,
                                    const WeightedDraws& points);

}  // namespace wearwell
