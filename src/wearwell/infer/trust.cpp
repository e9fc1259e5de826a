#include "wearwell/infer/trust.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/infer/diagnostics.h"
#include "wearwell/infer/power_scaling.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// Collects what is wrong; the worst finding sets the verdict.
class Findings {
 public:
  explicit Findings(std::string name) { check_.name = std::move(name); }

  void add(Verdict verdict, const std::string& detail, const std::string& advice) {
    if (verdict > check_.verdict) {
      check_.verdict = verdict;
      check_.advice = advice;
    }
    details_.push_back(detail);
  }

  Check result(const std::string& detail_if_none) {
    check_.detail =
        details_.empty() ? detail_if_none : fmt::format("{}", fmt::join(details_, "; "));
    return check_;
  }

 private:
  Check check_;
  std::vector<std::string> details_;
};

std::string in_unit(const Parameter& parameter, double si) {
  const std::string unit = parameter.unit.text == "1" ? "" : " " + parameter.unit.text;
  return fmt::format("{:.4g}{}", from_si(parameter.unit, si), unit);
}

Verdict dependence_on(const Parameter& parameter) {
  return std::holds_alternative<Flat>(parameter.prior.family) ? Verdict::fail : Verdict::warn;
}

Check proper_posterior(const Posterior& posterior, const Fit& fit) {
  Findings findings("proper-posterior");
  for (const Tail& tail : fit.tails) {
    const Parameter& parameter = posterior.parameters()[static_cast<std::size_t>(tail.parameter)];
    const std::string where =
        fmt::format("{} towards {}", parameter.name,
                    tail.towards_bound ? (tail.upward ? "its upper bound" : "its lower bound")
                    : tail.upward      ? "large values"
                                       : "minus infinity");
    const std::string give_prior = fmt::format(
        "Bound {} or give it a proper prior (half-normal, uniform with an upper bound): the data "
        "alone do not hold it.",
        parameter.name);
    const std::string power =
        tail.towards_bound
            ? fmt::format("its density grows like distance^{:.2f}", -tail.index)
            : fmt::format("its density goes like {}^{:.2f} far out", parameter.name, -tail.index);
    if (!tail.integrable()) {
      findings.add(Verdict::fail,
                   fmt::format("the posterior is improper: {}, {}, which has no finite integral; "
                               "every number depends "
                               "on where it was cut",
                               where, power),
                   give_prior);
    } else if (!tail.has_moment(1)) {
      findings.add(
          Verdict::fail,
          fmt::format(
              "the mean of {} does not exist: {}, {}, so the mean depends on where it was cut",
              parameter.name, where, power),
          give_prior);
    } else if (!tail.has_moment(2)) {
      findings.add(
          Verdict::warn,
          fmt::format(
              "the standard deviation of {} does not exist: {}, {}; read its quantiles instead",
              parameter.name, where, power),
          give_prior);
    }
  }
  return findings.result("every tail of every parameter falls fast enough for means and variances");
}

// The same posterior with the bounds of one parameter moved away from its mean to twice the
// distance; bounds set by physics stay.
Posterior with_cut_moved(const Posterior& posterior, std::size_t index, double mean) {
  std::vector<Parameter> parameters = posterior.parameters();
  Parameter& moved = parameters[index];
  const Law& prior = moved.prior;
  moved.prior =
      make_law(prior.family, std::max(moved.natural_lower, mean + 2 * (prior.lower - mean)),
               std::min(moved.natural_upper, mean + 2 * (prior.upper - mean)));
  return Posterior(std::move(parameters), posterior.shared_likelihood());
}

bool has_cut(const Parameter& parameter) {
  const Law& prior = parameter.prior;
  const bool flat =
      std::holds_alternative<Flat>(prior.family) || std::holds_alternative<Uniform>(prior.family);
  return flat && ((std::isfinite(prior.lower) && prior.lower != parameter.natural_lower) ||
                  (std::isfinite(prior.upper) && prior.upper != parameter.natural_upper));
}

Check prior_cut(const Posterior& posterior, const Fit& fit) {
  constexpr double tolerated = 0.25;  // standard deviations
  Findings findings("prior-cut");
  std::vector<std::string> passed;
  for (std::size_t i = 0; i < posterior.parameters().size(); ++i) {
    const Parameter& parameter = posterior.parameters()[i];
    if (!has_cut(parameter)) continue;
    if (!fit.exact) {
      findings.add(Verdict::warn,
                   fmt::format("the dependence on the bounds of {} was not examined ({})",
                               parameter.name, fit.no_exact),
                   "Fit again with other bounds and compare.");
      continue;
    }
    const std::string advice = fmt::format(
        "Say what is known of {}: a bound or a law that means something. More data make the bound "
        "matter less.",
        parameter.name);
    const Posterior wider =
        with_cut_moved(posterior, i, fit.exact->mean[static_cast<Eigen::Index>(i)]);
    const ExactPosterior exact = integrate(wider, fit.whitening);
    if (!exact.failure.empty()) {
      findings.add(
          dependence_on(parameter),
          fmt::format("with the bounds of {} at twice the distance the posterior cannot be "
                      "integrated ({})",
                      parameter.name, exact.failure),
          advice);
      continue;
    }
    const Eigen::VectorXd shift =
        (exact.mean - fit.exact->mean).cwiseAbs().cwiseQuotient(fit.exact->sd);
    Eigen::Index worst = 0;
    const double largest = shift.maxCoeff(&worst);
    const Parameter& moved = posterior.parameters()[static_cast<std::size_t>(worst)];
    const std::string detail = fmt::format(
        "with the bounds of {} at twice the distance, the mean of {} goes from {} to {} ({:.2f} "
        "standard deviations)",
        parameter.name, moved.name, in_unit(moved, fit.exact->mean[worst]),
        in_unit(moved, exact.mean[worst]), largest);
    if (largest > tolerated || std::isnan(largest)) {
      findings.add(dependence_on(parameter), detail, advice);
    } else {
      passed.push_back(detail);
    }
  }
  return findings.result(passed.empty() ? "no flat or uniform prior was cut"
                                        : fmt::format("{}", fmt::join(passed, "; ")));
}

// Densities relative to the highest one, from bins of a twentieth of the central 90 %.
class RelativeDensity {
 public:
  explicit RelativeDensity(const Distribution& distribution)
      : distribution_(distribution),
        width_((distribution.quantile(0.95) - distribution.quantile(0.05)) / 20) {
    const double first = distribution.quantile(0.05) - 20 * width_;
    double below = distribution.cdf(first);
    for (int i = 1; i <= 60; ++i) {
      const double next = distribution.cdf(first + i * width_);
      highest_ = std::max(highest_, next - below);
      below = next;
    }
  }

  double above(double x) const { return mass(x, x + width_) / highest_; }
  double below(double x) const { return mass(x - width_, x) / highest_; }

 private:
  double mass(double a, double b) const { return distribution_.cdf(b) - distribution_.cdf(a); }

  const Distribution& distribution_;
  double width_;
  double highest_ = 0;
};

Check bounds(const Posterior& posterior, const Fit& fit) {
  constexpr double worth_a_word = 0.3, piled_up = 0.6;
  Findings findings("bounds");
  const WeightedDraws& draws = fit.exact ? fit.exact->nodes : fit.pooled;
  for (std::size_t i = 0; i < posterior.parameters().size(); ++i) {
    const Parameter& parameter = posterior.parameters()[i];
    const Distribution marginal(draws, [i](const double* x) { return x[i]; });
    const RelativeDensity density(marginal);
    for (const bool lower : {true, false}) {
      const double bound = lower ? parameter.prior.lower : parameter.prior.upper;
      if (!std::isfinite(bound)) continue;
      const double ratio = lower ? density.above(bound) : density.below(bound);
      if (ratio < worth_a_word) continue;
      const bool natural = bound == (lower ? parameter.natural_lower : parameter.natural_upper);
      findings.add(
          ratio >= piled_up && !natural ? dependence_on(parameter) : Verdict::warn,
          fmt::format("the density of {} at its {}{} bound {} is {:.0f} % of its highest",
                      parameter.name, natural ? "physical " : "", lower ? "lower" : "upper",
                      in_unit(parameter, bound), 100 * std::min(1.0, ratio)),
          natural
              ? fmt::format("The data do not tell {} from its bound.", parameter.name)
              : fmt::format("The answer rests on the bound of {}. If the bound is not knowledge, "
                            "move it.",
                            parameter.name));
    }
  }
  return findings.result("no parameter piles up at a bound");
}

// Do a stronger prior and a stronger likelihood move the mean of `draws` in opposite directions?
// The derivative of a mean by the logarithm of a power is the covariance with the scaled component.
bool pulled_apart(const Eigen::VectorXd& draws, const std::vector<double>& log_prior,
                  const std::vector<double>& log_likelihood) {
  const Eigen::ArrayXd centered = draws.array() - draws.mean();
  const auto covariance = [&](const std::vector<double>& component) {
    return (centered * Eigen::Map<const Eigen::ArrayXd>(component.data(), draws.size())).sum();
  };
  return covariance(log_prior) * covariance(log_likelihood) < 0;
}

Check prior_data_conflict(const Posterior& posterior, const Fit& fit) {
  Findings findings("prior-data-conflict");
  const Eigen::MatrixXd& values = fit.pooled.values;
  std::vector<double> log_prior, log_likelihood;
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    const Eigen::VectorXd x = values.row(row);
    log_prior.push_back(posterior.log_prior(view(x)));
    log_likelihood.push_back(posterior.likelihood().value(view(x)));
  }
  std::vector<std::string> passed;
  for (std::size_t i = 0; i < posterior.parameters().size(); ++i) {
    const Parameter& parameter = posterior.parameters()[i];
    const Eigen::VectorXd draws = values.col(static_cast<Eigen::Index>(i));
    const PowerScaling sensitivity = power_scaling(view(draws), log_prior, log_likelihood);
    const std::string numbers =
        fmt::format("{}: sensitivity to the prior {:.3f}, to the likelihood {:.3f}", parameter.name,
                    sensitivity.prior, sensitivity.likelihood);
    switch (verdict(sensitivity)) {
      case PowerScalingVerdict::prior_data_conflict:
        if (pulled_apart(draws, log_prior, log_likelihood)) {
          findings.add(
              Verdict::fail, numbers,
              fmt::format(
                  "Prior and data disagree about {}: each pulls its own way. Ask whether the prior "
                  "describes this component and these conditions.",
                  parameter.name));
          break;
        }
        [[fallthrough]];  // both matter, and agree: few data, or a prior that says much
      case PowerScalingVerdict::strong_prior_or_weak_likelihood:
        findings.add(
            Verdict::warn, numbers,
            fmt::format("What is said of {} comes from the prior as well as from the data.",
                        parameter.name));
        break;
      case PowerScalingVerdict::unknown:
        findings.add(Verdict::warn, fmt::format("{}: unknown", parameter.name),
                     "The draws are not finite or do not vary.");
        break;
      case PowerScalingVerdict::none:
        passed.push_back(numbers);
    }
  }
  return findings.result(fmt::format("{}", fmt::join(passed, "; ")));
}

Check convergence(const Posterior& posterior, const Fit& fit, bool agrees_with_exact) {
  constexpr double largest_rhat = 1.01,
                   tolerable_rhat = 1.05;  // the latter where quadrature agrees
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
          "Draw more (--draws, --warmup), or use --method nuts or exact.");
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
                             agrees_with_exact ? ", but quadrature agrees" : ""),
                 "The sampler may have missed a narrow region: raise [sampler] target_accept, or "
                 "compare with --method exact.");
  }
  if (deepest > 0) {
    findings.add(Verdict::warn,
                 fmt::format("{} of {} transitions reached the tree depth limit {}", deepest, total,
                             max_treedepth),
                 "The sampler is slow here: raise [sampler] max_treedepth or use a dense metric.");
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
  constexpr double tolerated = 4;  // Monte Carlo standard errors
  Findings findings("exact-agreement");
  if (!fit.exact) {
    findings.add(Verdict::warn, fmt::format("no exact posterior to compare with: {}", fit.no_exact),
                 "Rely on the other checks.");
    return findings.result("");
  }
  double worst = 0;
  for (std::size_t i = 0; i < fit.diagnostics.size(); ++i) {
    const auto value = [i](const double* x) { return x[i]; };
    const Distribution exact(fit.exact->nodes, value), drawn(fit.pooled, value);
    const Diagnostics& d = fit.diagnostics[i];
    std::vector<std::pair<std::string, double>> distances = {
        {"5 % quantile", (drawn.quantile(0.05) - exact.quantile(0.05)) / d.mcse_q05},
        {"median", (drawn.quantile(0.5) - exact.quantile(0.5)) / d.mcse_q50},
        {"95 % quantile", (drawn.quantile(0.95) - exact.quantile(0.95)) / d.mcse_q95}};
    // A mean without variance has no Monte Carlo standard error to speak of.
    if (std::isfinite(fit.exact->sd[static_cast<Eigen::Index>(i)])) {
      distances.emplace_back("mean", (drawn.mean() - exact.mean()) / d.mcse_mean);
    }
    for (const auto& [what, distance] : distances) {
      worst = std::max(worst, std::abs(distance));
      if (!(std::abs(distance) <= tolerated)) {
        findings.add(
            Verdict::fail,
            fmt::format("the {} of {} is {:.1f} Monte Carlo standard errors from the exact one",
                        what, posterior.parameters()[i].name, distance),
            "Believe the exact numbers, and draw more.");
      }
    }
  }
  return findings.result(
      fmt::format("within {:.1f} Monte Carlo standard errors of quadrature", worst));
}

}  // namespace

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
