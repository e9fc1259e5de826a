#include "wearwell/infer/trust.h"

#include <algorithm>

#include "wearwell/infer/prior_checks.h"
#include "wearwell/infer/sampler_checks.h"

namespace wearwell {

std::vector<Check> trust_checks(const Posterior& posterior, const Fit& fit) {
  std::vector<Check> checks = {proper_posterior(posterior, fit)};
  if (checks[0].verdict != Verdict::fail) {
    checks.push_back(prior_cut(posterior, fit));
    checks.push_back(bounds(posterior, fit));
    checks.push_back(prior_data_conflict(posterior, fit));
  }
  if (fit.method == Method::exact) return checks;

  const Check agreement = exact_agreement(posterior, fit);
  const bool agrees = agreement.verdict == Verdict::pass;
  checks.push_back(convergence(posterior, fit, agrees));
  if (fit.method == Method::nuts) {
    checks.push_back(divergences(fit, agrees));
    checks.push_back(energy(fit));
  }
  checks.push_back(agreement);
  return checks;
}

bool trusted(const std::vector<Check>& checks) {
  return std::none_of(checks.begin(), checks.end(),
                      [](const Check& check) { return check.verdict == Verdict::fail; });
}

}  // namespace wearwell
