#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/stage.h"

namespace wearwell {

/// Looks at up to 200 of these points, evenly by their weight: in how many the likelihood left integrals
/// within it open (LogDensity::unsettled), and by how much.
std::vector<StageDiagnostic> unsettled_effects(const Posterior& posterior,
                                               const WeightedDraws& points);

}  // namespace wearwell
