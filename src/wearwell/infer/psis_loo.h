#pragma once

#include <stop_token>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/loo.h"

/// Leave-one-out without fitting anew: draws of the whole posterior, weighted by one over the density of
/// the observation that is left out, the largest weights smoothed (pareto_smoothing.h).
namespace wearwell {

/// Empty terms when the likelihood is no product of observations. `draws` have one weight, and count
/// for `efficiency` times as many independent ones. `scores`, when given, are of the terms one by
/// one, and ask for their tails.
Loo psis_loo(const LogDensity& likelihood, const WeightedDraws& draws, double efficiency = 1,
             const Scores* scores = nullptr);

/// The same. Where `fit` holds an exact posterior the densities are integrated over its nodes, and
/// terms whose weights are uneven are fitted anew by quadrature; k-hat remains that of the draws. Throws
/// `Cancelled` once `stop` is requested.
Loo leave_one_out(const Posterior& posterior, const Fit& fit, const Scores* scores = nullptr,
                  const std::stop_token& stop = {});

/// The exact elpd of one term: quadrature of the posterior of all others; NaN where that fails.
double exact_elpd(const Posterior& posterior, const Whitening& whitening, std::size_t term);

}  // namespace wearwell
