#include "wearwell/infer/trust.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/infer/prior_checks.h"
#include "wearwell/infer/sampler_checks.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// Threshold for the log density at the mode minus that of the highest node.
constexpr double most_above = 3;
// Threshold for the highest point of a search minus its starting draws; a peak with mass between
// the draws would be higher.
constexpr double most_above_draws = 5;

}  // namespace

std::vector<Check> trust_checks(const Posterior& posterior, const Fit& fit) {
  std::vector<Check> checks = {proper_posterior(posterior, fit)};
  if (checks[0].verdict != Verdict::fail) {
    checks.push_back(prior_cut(posterior, fit));
    checks.push_back(bounds(posterior, fit));
    checks.push_back(prior_data_conflict(posterior, fit));
  }
  const auto with_computation = [&] {
    std::string detail = "every stage completed";
    if (!fit.maxima.found.empty()) detail += "; " + description(posterior, fit.maxima);
    if (fit.exact)
      detail += fmt::format("; quadrature to an estimated relative {:.1g}", fit.exact->error);
    checks.push_back(computation(fit.stage_diagnostics, detail));
    return checks;
  };
  if (fit.method == Method::exact) return with_computation();

  const Check agreement = exact_agreement(posterior, fit);
  const bool agrees = agreement.verdict == Verdict::pass;
  checks.push_back(convergence(posterior, fit, agrees));
  if (fit.method == Method::nuts) {
    checks.push_back(divergences(fit, agrees));
    checks.push_back(energy(fit));
  }
  checks.push_back(agreement);
  return with_computation();
}

std::vector<StageDiagnostic> later_stage_diagnostics(const Posterior& posterior, const Fit& fit,
                                                     const NaturalMode& mode) {
  std::vector<StageDiagnostic> found;
  if (mode.problem.empty() && fit.exact) {
    const double there = posterior.value(view(posterior.to_real(view(mode.position))));
    if (there > fit.exact->highest + most_above) {
      found.push_back(
          {Stage::quadrature, Verdict::fail,
           fmt::format("at the mode the density is e^{:.1f} times that of any node",
                       there - fit.exact->highest),
           "The posterior has a narrow peak that quadrature missed: do not use any number."});
    }
  }
  if (mode.fell_short) {
    // If the search rose only slightly above the draws, it is on a plateau or at an edge (a scatter
    // of zero), and the draws miss no mass.
    const bool missed = !(mode.above_draws < most_above_draws);
    found.push_back({Stage::constrained_mode, missed ? Verdict::fail : Verdict::warn,
                     missed ? mode.problem
                            : fmt::format("{}; the draws do not miss mass: the search reached only "
                                          "e^{:.1f} times their density",
                                          mode.problem, mode.above_draws),
                     "Do not compare with published maximum likelihood fits; give informative "
                     "priors for all parameters."});
  }
  return found;
}

bool trusted(const std::vector<Check>& checks) {
  return std::none_of(checks.begin(), checks.end(),
                      [](const Check& check) { return check.verdict == Verdict::fail; });
}

}  // namespace wearwell
