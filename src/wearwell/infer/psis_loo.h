#pragma once

#include <stop_token>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/loo.h"

/// Leave-one-out without refitting: draws of the whole posterior weighted by the inverse density of
/// the omitted observation, with the largest weights smoothed (pareto_smoothing.h).
namespace wearwell {

/// Without terms if the likelihood is not a product over observations. `draws` are equally
/// weighted, with `efficiency` independent draws each. `scores` of the terms, if given, request
/// tail probabilities.
Loo psis_loo(const LogDensity& likelihood, const WeightedDraws& draws, double efficiency = 1,
             const Scores* scores = nullptr);

/// The same for a fit. With an exact posterior the densities are integrated over its nodes, and
/// terms with uneven weights are refitted by quadrature; k-hat remains that of the draws. Throws
/// `Cancelled` once `stop` is requested.
Loo leave_one_out(const Posterior& posterior, const Fit& fit, const Scores* scores = nullptr,
                  const std::stop_token& stop = {});

/// The exact elpd of one term by quadrature of the posterior of all others; NaN if that fails.
double exact_elpd(const Posterior& posterior, const Whitening& whitening, std::size_t term);

}  // namespace wearwell
