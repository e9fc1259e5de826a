#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/stage.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// Do double-precision numbers carry this posterior? Not where a parameter is known to fewer than ten
/// thousand neighbouring doubles (its scatter went to zero, or the data agree to their last digits),
/// nor where differences of large numbers leave noise of more than a thousandth in the log density.
/// `points` are of the posterior; the noise is measured about the whitening's center, by differences
/// of eighth order, which know no smooth function (Hamming's table; More and Wild 2011).
std::vector<StageDiagnostic> digits(const Posterior& posterior, const Whitening& whitening,
                                    const WeightedDraws& points);

}  // namespace wearwell
