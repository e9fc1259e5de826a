#include "wearwell/infer/sampler_checks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "wearwell/infer/agreement.h"
#include "wearwell/infer/diagnostics.h"

namespace wearwell {

namespace {

// Advice for this method, and an alternative method.
std::string draw_more(const Fit& fit) {
  if (fit.exact) return "Draw more (--draws, --warmup), or use --method exact.";
  if (fit.method == Method::metropolis) {
    return "Draw more (--draws, --warmup), or use --method nuts.";
  }
  return "Draw more (--draws, --warmup); if that does not help, more informative priors make the "
         "posterior easier to sample.";
}

}  // namespace

Check convergence(const Posterior& posterior, const Fit& fit, bool agrees_with_exact) {
  constexpr double largest_rhat = 1.01,
                   tolerable_rhat = 1.05;  // the latter if quadrature agrees
  const double least_ess = 100.0 * static_cast<double>(fit.draws.size());
  Findings findings("convergence");
  double rhat = 0, ess = INFINITY;
  for (std::size_t i = 0; i < fit.diagnostics.size(); ++i) {
    const Diagnostics& d = fit.diagnostics[i];
    const double least = std::min(d.ess_bulk, d.ess_tail);
    rhat = std::max(rhat, d.rhat);
    ess = std::min(ess, least);
    if (!(d.rhat <= largest_rhat) || !(least >= least_ess)) {
      const bool tolerable =
          agrees_with_exact && d.rhat <= tolerable_rhat && least >= 0.25 * least_ess;
      findings.add(
          tolerable ? Verdict::warn : Verdict::fail,
          fmt::format(
              "{}: R-hat {:.3f} (at most {}), effective draws {:.0f} in bulk and {:.0f} in the "
              "tails (at least {:.0f})",
              posterior.parameters()[i].name, d.rhat, largest_rhat, d.ess_bulk, d.ess_tail,
              least_ess),
          draw_more(fit));
    }
  }
  return findings.result(
      fmt::format("R-hat at most {:.4f}, at least {:.0f} effective draws", rhat, ess));
}

Check divergences(const Fit& fit, bool agrees_with_exact) {
  const int max_treedepth = fit.max_treedepth;
  constexpr double tolerated = 0.005;
  Findings findings("divergences");
  long divergent = 0, deepest = 0, total = 0;
  for (const Chain& chain : fit.draws) {
    for (const NutsStep& step : chain.nuts) {
      divergent += step.divergent;
      deepest += step.treedepth >= max_treedepth;
      ++total;
    }
  }
  const auto share = static_cast<double>(divergent) / static_cast<double>(total);
  if (divergent > 0) {
    findings.add(share > tolerated && !agrees_with_exact ? Verdict::fail : Verdict::warn,
                 fmt::format("{} of {} transitions diverged{}", divergent, total,
                             agrees_with_exact ? ", but quadrature agrees with the draws" : ""),
                 agrees_with_exact
                     ? "No action is needed: the numbers are those of quadrature."
                     : fmt::format("The sampler may have missed a narrow region: raise [sampler] "
                                   "target_accept{}.",
                                   fit.exact ? ", or use --method exact" : ""));
  }
  if (deepest > 0) {
    findings.add(Verdict::warn,
                 fmt::format("{} of {} transitions reached the tree depth limit {}", deepest, total,
                             max_treedepth),
                 proper(fit) ? "The sampler is slow here: raise [sampler] max_treedepth or use a "
                               "dense metric."
                             : "Give priors that make the posterior proper.");
  }
  return findings.result(fmt::format("none in {} transitions", total));
}

Check energy(const Fit& fit) {
  constexpr double least = 0.3;
  Findings findings("energy");
  double lowest = INFINITY;
  for (const Chain& chain : fit.draws) {
    std::vector<double> energies;
    for (const NutsStep& step : chain.nuts) energies.push_back(step.energy);
    const double fraction = e_bfmi(energies);
    lowest = std::isnan(fraction) ? fraction : std::min(lowest, fraction);
  }
  const std::string detail =
      fmt::format("E-BFMI at least {:.2f} (more than {} is good)", lowest, least);
  if (!(lowest > least)) {
    findings.add(Verdict::warn, detail,
                 "The posterior has heavy tails for the sampler: draw more, or bound the scatter.");
  }
  return findings.result(detail);
}

Check exact_agreement(const Posterior& posterior, const Fit& fit) {
  Findings findings("exact-agreement");
  if (!fit.exact) {
    findings.add(Verdict::warn, fmt::format("no quadrature to compare with: {}", fit.no_exact),
                 "Rely on the other checks.");
    return findings.result("");
  }
  double worst = 0;
  for (const Disagreement& each : distances_from_exact(fit)) {
    worst = std::max(worst, std::abs(each.errors));
  }
  for (const Disagreement& each : disagreements(fit, agreement_level)) {
    findings.add(Verdict::fail,
                 fmt::format("the {} of {} is {:.1f} Monte Carlo standard errors from quadrature",
                             each.number, posterior.parameters()[each.parameter].name, each.errors),
                 "Use the numbers by quadrature, and draw more.");
  }
  return findings.result(
      fmt::format("within {:.1f} Monte Carlo standard errors of quadrature{}", worst,
                  fit.redrawn ? "; the first draws disagreed and were repeated" : ""));
}

}  // namespace wearwell
