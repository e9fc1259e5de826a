#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/check.h"
#include "wearwell/infer/constrained_mode.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/loo.h"

namespace wearwell {

/// All checks that apply to this fit (prior_checks.h, sampler_checks.h), in order of importance:
/// proper-posterior, prior-bounds, bounds, prior-data-conflict, convergence, divergences, energy,
/// exact-agreement, computation. The last reports shortfalls of any stage of the computation
/// (stage.h).
///
/// A `flat` prior represents no knowledge, so a result that depends on its bounds fails. A
/// `uniform` prior, or a bound of another prior, is knowledge, so the same dependence is a warning.
std::vector<Check> trust_checks(const Posterior& posterior, const Fit& fit);

/// Shortfalls of the stages after the fit, to be added to those of the fit.
std::vector<StageDiagnostic> later_stage_diagnostics(const Posterior& posterior, const Fit& fit,
                                                     const NaturalMode& mode);

/// Whether no check fails.
bool trusted(const std::vector<Check>& checks);

}  // namespace wearwell
