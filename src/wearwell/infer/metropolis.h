#pragma once

#include <Eigen/Dense>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/settings.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// One chain of Metropolis-Hastings on the natural parameters (An et al. 2011, Table 4): each
/// proposal moves every parameter uniformly within +- its half width (SI, > 0 each) and is accepted
/// with probability min(1, ratio of densities); settings.warmup iterations are discarded.
Chain metropolis_chain(const Posterior& posterior, const Eigen::VectorXd& start,
                       const Eigen::VectorXd& half_width, const RunSettings& settings, Rng& rng);

/// One chain of random-walk Metropolis on the whitened real line, from `start` there: normal steps
/// of one length in every direction. Warm-up adapts the directions to its draws (Haario et al.
/// 2001, in two windows) and the length towards an acceptance of 0.35; both are then fixed.
Chain whitened_metropolis_chain(const Posterior& posterior, const Whitening& whitening,
                                const Eigen::VectorXd& start, const RunSettings& settings,
                                Rng& rng);

}  // namespace wearwell
