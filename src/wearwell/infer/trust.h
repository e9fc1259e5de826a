#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/check.h"
#include "wearwell/infer/constrained_mode.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/loo.h"

namespace wearwell {

/// All checks that apply to this fit (prior_checks.h, sampler_checks.h), in the order in which a reader should care:
/// proper-posterior, prior-bounds, bounds, prior-data-conflict, convergence, divergences, energy, exact-agreement,
/// computation. The last tells what any stage of the computation fell short of (stage.h).
///
/// A `flat` law is the absence of knowledge: an answer that hangs on where it was cut fails. A `uniform` law, or a bound on
/// another law, is knowledge: the same dependence is a warning.
std::vector<Check> trust_checks(const Posterior& posterior, const Fit& fit);

/// What the stages after the fit fell short of, to be added to its own.
std::vector<StageDiagnostic> later_stage_diagnostics(const Posterior& posterior, const Fit& fit,
                                                     const NaturalMode& mode);

/// No check fails.
bool trusted(const std::vector<Check>& checks);

}  // namespace wearwell
