#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/stage.h"

namespace wearwell {

/// Checks up to 200 of these points, evenly by weight: at how many the integrals in the likelihood
/// missed their tolerance (LogDensity::unsettled), and by how much.
std::vector<StageDiagnostic> unsettled_effects(const Posterior& posterior,
                                               const WeightedDraws& points);

}  // namespace wearwell
