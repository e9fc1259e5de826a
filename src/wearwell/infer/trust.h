#pragma once

#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/fit.h"

namespace wearwell {

enum class Verdict { pass, warn, fail };

/// One reason to believe the numbers or not.
struct Check {
  std::string name;
  Verdict verdict = Verdict::pass;
  std::string detail;  ///< what was found, in numbers
  std::string advice;  ///< what to do about it; empty when it passes
};

/// All checks that apply to this fit, in the order in which a reader should care:
///
///   proper-posterior      every tail is integrable, and means and variances exist (tail.h)
///   prior-cut             moving the bounds of a flat or uniform prior outward does not move the
///   means bounds                the posterior does not pile up at a bound prior-data-conflict
///   power scaling of prior and likelihood (power_scaling.h) convergence           R-hat and
///   effective sample sizes (diagnostics.h) divergences           NUTS followed the posterior
///   everywhere; tree depth did not end its walks energy                E-BFMI of every chain
///   exact-agreement       sampler against quadrature, in Monte Carlo standard errors
///
/// A `flat` law is the absence of knowledge: an answer that hangs on where it was cut fails. A
/// `uniform` law, or a bound on another law, is knowledge: the same dependence is a warning.
std::vector<Check> trust_checks(const Posterior& posterior, const Fit& fit);

/// No check fails.
bool trusted(const std::vector<Check>& checks);

}  // namespace wearwell
