#pragma once

#include <Eigen/Dense>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/settings.h"

namespace wearwell {

/// One chain of Metropolis-Hastings on the natural parameters, as An et al. (2011, Table 4) print
/// it: each proposal moves every parameter uniformly within +- its half width and is accepted with
/// probability min(1, ratio of densities); settings.warmup iterations are discarded.
///
/// `half_width` in SI, > 0 each. With `tune`, warm-up multiplies them by one common factor towards
/// an acceptance of 0.35; otherwise they stay as given.
Chain metropolis_chain(const Posterior& posterior, const Eigen::VectorXd& start,
                       const Eigen::VectorXd& half_width, bool tune, const RunSettings& settings,
                       Rng& rng);

}  // namespace wearwell
