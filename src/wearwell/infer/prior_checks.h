#pragma once

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/check.h"
#include "wearwell/infer/fit.h"

namespace wearwell {

/// Checks of the problem rather than of the computation: prior, data and posterior.

/// Every tail is integrable, and means and variances exist (tail.h).
Check proper_posterior(const Posterior& posterior, const Fit& fit);

/// Moving the bounds of a flat or uniform prior outward does not move the means.
Check prior_cut(const Posterior& posterior, const Fit& fit);

/// The posterior does not accumulate at a bound.
Check bounds(const Posterior& posterior, const Fit& fit);

/// Prior and likelihood do not contradict each other about a parameter (power_scaling.h).
Check prior_data_conflict(const Posterior& posterior, const Fit& fit);

}  // namespace wearwell
