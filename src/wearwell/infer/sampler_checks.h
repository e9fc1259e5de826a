#pragma once

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/check.h"
#include "wearwell/infer/fit.h"

namespace wearwell {

/// Checks of the draws. Slow convergence and divergences are only warnings if quadrature agrees
/// with the draws.

/// R-hat and effective sample sizes (diagnostics.h).
Check convergence(const Posterior& posterior, const Fit& fit, bool agrees_with_exact);

/// Divergences of NUTS, and transitions that reached the tree depth limit.
Check divergences(const Fit& fit, bool agrees_with_exact);

/// E-BFMI of every chain.
Check energy(const Fit& fit);

/// The difference between draws and quadrature, in Monte Carlo standard errors.
Check exact_agreement(const Posterior& posterior, const Fit& fit);

}  // namespace wearwell
