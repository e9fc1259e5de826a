#pragma once

#include <optional>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/loo.h"

namespace wearwell {

/// Leave-one-out of very many observations, each of which moves the posterior hardly at all: sums over the few points of a rule of
/// degree 5 (McNamee and Stenger 1967, Numerische Mathematik 10, 327-344) for the normal distribution with the mean and covariance of the
/// nodes of `fit.exact`, on the real line. The thousand most uneven terms have a k-hat, the largest part of the posterior's
/// precision in any direction that is theirs; that of all others is -infinity. Tails are those at the middle of the posterior. `error`
/// is what the points make of the mean log likelihood against what quadrature does, and all that third cumulants do to elpd.
///
/// None where one observation moves the posterior by more (lpd - elpd above 0.05), where that error is above 0.1, and of more
/// than four parameters.
std::optional<Loo> loo_at_points(const Posterior& posterior, const Fit& fit, const Scores* scores);

}  // namespace wearwell
