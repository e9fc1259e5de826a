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
/// A `flat` prior is the absence of knowledge: an answer that depends on where it is truncated fails. A `uniform` prior, or a
/// bound on another distribution, is knowledge: the same dependence is a warning.
std::vector<Check> trust_checks(const Posterior& posterior, const Fit& fit);

/// What the stages after the fit did not reach, to be added to its own shortfalls.
std::vector<StageDiagnostic> later_stage_diagnostics(const Posterior& posterior, const Fit& fit,
                                                     const NaturalMode& mode);

/// Whether no check fails.
bool trusted(const std::vector<Check>& checks);

}  // namespace wearwell
