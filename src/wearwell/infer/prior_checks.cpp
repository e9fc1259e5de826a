#include "wearwell/infer/prior_checks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/infer/maxima_mixture.h"
#include "wearwell/infer/power_scaling.h"
#include "wearwell/math/view.h"

// Longer than others: the checks of a prior share its bounds and the integrals without them.
namespace wearwell {
namespace {

std::string in_unit(const Parameter& parameter, double si) {
  const std::string unit = parameter.unit.text == "1" ? "" : " " + parameter.unit.text;
  return fmt::format("{:.4g}{}", from_si(parameter.unit, si), unit);
}

// A template line of the study for a prior of this parameter.
std::string prior_line(const Parameter& parameter) {
  const std::string& unit = parameter.unit.text;
  const std::string number = unit == "1" ? "..." : fmt::format("\"... {}\"", unit);
  const bool scale = parameter.natural_lower == 0 && !is_logarithm(parameter.si);
  if (scale)
    return fmt::format("{} = {{ distribution = \"half-normal\", scale = {} }}", parameter.name,
                       number);
  return fmt::format("{} = {{ distribution = \"normal\", mean = {}, sd = {} }}", parameter.name,
                     number, is_logarithm(parameter.si) ? "..." : number);
}

Verdict dependence_on(const Parameter& parameter) {
  return parameter.prior.family.id == ResponseFamily::flat ? Verdict::fail : Verdict::warn;
}

}  // namespace

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
        "The data alone do not determine {}. State prior knowledge as bounds or a prior such as {}",
        parameter.name, prior_line(parameter));
    if (!tail.known) {
      findings.add(
          Verdict::fail,
          fmt::format("the posterior may be improper: the tail of {} could not be measured", where),
          give_prior);
      continue;
    }
    const std::string power =
        tail.towards_bound ? fmt::format("its density increases like distance^{:.2f}", -tail.index)
                           : fmt::format("its density behaves like {}^{:.2f} in the tail",
                                         parameter.name, -tail.index);
    if (!tail.integrable()) {
      findings.add(Verdict::fail,
                   fmt::format("the posterior is improper: {}, {}, whose integral is infinite; "
                               "every number depends on where it is truncated",
                               where, power),
                   give_prior);
    } else if (!tail.has_moment(1)) {
      findings.add(
          Verdict::fail,
          fmt::format(
              "the mean of {} does not exist: {}, {}, so the mean depends on where it is truncated",
              parameter.name, where, power),
          give_prior);
    } else if (!tail.has_moment(2)) {
      findings.add(
          Verdict::warn,
          fmt::format(
              "the standard deviation of {} does not exist: {}, {}; use its quantiles instead",
              parameter.name, where, power),
          give_prior);
    }
  }
  return findings.result(
      "the tails of all parameters decrease fast enough for means and variances");
}

namespace {

// The same posterior with the bounds of one parameter moved to twice the distance from its mean;
// physical bounds stay.
Posterior with_cut_moved(const Posterior& posterior, std::size_t index, double mean) {
  std::vector<Parameter> parameters = posterior.parameters();
  Parameter& moved = parameters[index];
  const Distribution& prior = moved.prior;
  moved.prior = make_distribution(prior.family,
                                  std::max(moved.natural_lower, mean + 2 * (prior.lower - mean)),
                                  std::min(moved.natural_upper, mean + 2 * (prior.upper - mean)));
  return Posterior(std::move(parameters), posterior.likelihood());
}

// Other bounds imply other transforms, so positions on the real line change.
Whitening whitening_of(const Posterior& wider, const Posterior& posterior, const Fit& fit) {
  Eigen::VectorXd x(posterior.dimension());
  posterior.to_natural(view(fit.whitening.center), view(x));
  const Eigen::VectorXd center = wider.to_real(view(x));
  const Mode mode = find_mode(wider, center);
  return mode.found ? whitening_at(mode) : Whitening{center, fit.whitening.scale};
}

// The other local maxima, on the real line of the wider posterior.
std::vector<Mode> maxima_of(const Posterior& wider, const Posterior& posterior, const Fit& fit) {
  std::vector<Mode> maxima;
  Eigen::VectorXd x(posterior.dimension());
  for (const Mode& each : fit.other_maxima()) {
    posterior.to_natural(view(each.position), view(x));
    Mode there = find_mode(wider, wider.to_real(view(x)));
    if (there.found) maxima.push_back(std::move(there));
  }
  return maxima;
}

bool has_cut(const Parameter& parameter) {
  const Distribution& prior = parameter.prior;
  const bool flat = is_flat(prior);
  return flat && ((std::isfinite(prior.lower) && prior.lower != parameter.natural_lower) ||
                  (std::isfinite(prior.upper) && prior.upper != parameter.natural_upper));
}

// An upper estimate of the mass outside the bounds and of the resulting shift of a mean, assuming
// that the density outside is at most that at the bound.
struct LeftOut {
  double share = 0;
  double shift = 0;  // standard deviations
};

LeftOut left_out(const Posterior& wider, const Posterior& posterior, const Fit& fit,
                 std::size_t index) {
  const QuantityDistribution& marginal = fit.marginals[index];
  const auto at = static_cast<Eigen::Index>(index);
  const double mean = fit.exact->mean[at], sd = fit.exact->sd[at];
  const double width = (marginal.quantile(0.95) - marginal.quantile(0.05)) / 20;
  const Distribution &cut = posterior.parameters()[index].prior,
                     &moved = wider.parameters()[index].prior;
  LeftOut all;
  for (const bool lower : {true, false}) {
    const double edge = lower ? cut.lower : cut.upper, end = lower ? moved.lower : moved.upper;
    if (edge == end) continue;
    const double inside = lower ? marginal.cdf(edge + width) - marginal.cdf(edge)
                                : marginal.cdf(edge) - marginal.cdf(edge - width);
    const double share = inside / width * std::abs(end - edge);
    all.share += share;
    all.shift += share * std::abs(end - mean) / sd;
  }
  return all;
}

// The effect of moving the bounds of one parameter; empty without such bounds.
struct CutFinding {
  std::optional<Verdict> verdict;
  std::string detail;
};

CutFinding moved_cut(const Posterior& posterior, const Fit& fit, std::size_t index) {
  constexpr double tolerated = 0.25;      // standard deviations
  constexpr double without_error = 1e-3;  // a shift below the resolution of the integration
  const Parameter& parameter = posterior.parameters()[index];
  if (!has_cut(parameter)) return {};
  if (!fit.exact) {
    return {Verdict::warn, fmt::format("the dependence on the bounds of {} was not examined ({})",
                                       parameter.name, fit.no_exact)};
  }
  const Posterior wider =
      with_cut_moved(posterior, index, fit.exact->mean[static_cast<Eigen::Index>(index)]);
  const LeftOut out = left_out(wider, posterior, fit, index);
  if (out.shift < without_error) {
    return {Verdict::pass, fmt::format("moving the bounds of {} to twice the distance from its "
                                       "mean would add less than {:.1g} of the posterior",
                                       parameter.name, std::max(out.share, 1e-12))};
  }
  // An accuracy of a thousandth of a standard deviation suffices to detect a quarter.
  const ExactPosterior exact = integrate(wider, whitening_of(wider, posterior, fit),
                                         {.tolerance = 1e-3,
                                          .cells = false,
                                          .along_ridge = fit.exact->along_ridge,
                                          .maxima = maxima_of(wider, posterior, fit)});
  if (!exact.failure.empty()) {
    return {dependence_on(parameter),
            fmt::format("with the bounds of {} at twice the distance from its mean the "
                        "posterior cannot be "
                        "integrated ({})",
                        parameter.name, exact.failure)};
  }
  const Eigen::VectorXd shift =
      (exact.mean - fit.exact->mean).cwiseAbs().cwiseQuotient(fit.exact->sd);
  Eigen::Index worst = 0;
  const double largest = shift.maxCoeff(&worst);
  const Parameter& moved = posterior.parameters()[static_cast<std::size_t>(worst)];
  const bool depends = largest > tolerated || std::isnan(largest);
  return {depends ? dependence_on(parameter) : Verdict::pass,
          fmt::format("with the bounds of {} at twice the distance from its mean, the mean of {} "
                      "goes from {} to {} ({:.2f} standard deviations)",
                      parameter.name, moved.name, in_unit(moved, fit.exact->mean[worst]),
                      in_unit(moved, exact.mean[worst]), largest)};
}

}  // namespace

Check prior_cut(const Posterior& posterior, const Fit& fit) {
  std::vector<CutFinding> each(posterior.parameters().size());
  tbb::parallel_for(std::size_t{0}, each.size(),
                    [&](std::size_t i) { each[i] = moved_cut(posterior, fit, i); });
  Findings findings("prior-bounds");
  std::vector<std::string> passed;
  for (std::size_t i = 0; i < each.size(); ++i) {
    if (!each[i].verdict) continue;
    if (*each[i].verdict == Verdict::pass) {
      passed.push_back(each[i].detail);
      continue;
    }
    findings.add(*each[i].verdict, each[i].detail,
                 fit.exact ? fmt::format("State a meaningful bound or distribution for {}. More "
                                         "data make the bound matter less.",
                                         posterior.parameters()[i].name)
                           : "Fit again with other bounds and compare.");
  }
  return findings.result(passed.empty() ? "no flat or uniform prior has bounds"
                                        : fmt::format("{}", fmt::join(passed, "; ")));
}

namespace {

// Densities relative to the highest one, from bins of a twentieth of the central 90 %.
class RelativeDensity {
 public:
  // `finest` is the smallest probability that the distribution resolves.
  RelativeDensity(const QuantityDistribution& distribution, double finest)
      : distribution_(distribution),
        finest_(finest),
        width_((distribution.quantile(0.95) - distribution.quantile(0.05)) / 20) {
    const double first = distribution.quantile(0.05) - 20 * width_;
    double below = distribution.cdf(first);
    for (int i = 1; i <= 60; ++i) {
      const double next = distribution.cdf(first + i * width_);
      highest_ = std::max(highest_, next - below);
      below = next;
    }
  }

  double above(double x) const { return refined(mass(x, x + width_) / highest_, x, 1); }
  double below(double x) const { return refined(mass(x - width_, x) / highest_, x, -1); }

 private:
  double mass(double a, double b) const { return distribution_.cdf(b) - distribution_.cdf(a); }

  // A bin does not determine the density at its edge: a bin of a skewed distribution may contain
  // most of the mass and yet begin far from the bound. So for a suspicious bin, the density of
  // successively smaller probabilities next to the bound is examined.
  double refined(double ratio, double bound, int inward) const {
    constexpr double accused = 0.3, alike = 0.8;
    if (!(ratio >= accused)) return ratio;
    const auto density = [&](double share) {
      const double end = distribution_.quantile(inward > 0 ? share : 1 - share);
      return share / std::abs(end - bound);
    };
    double highest = highest_ / width_, at_bound = highest;
    constexpr double first = 0.05;
    for (double share = first; share >= finest_; share /= 2) {
      at_bound = density(share);
      highest = std::max(highest, at_bound);
    }
    // Between quantiles, if the distribution is narrower than a bin.
    for (double p = first; p < 1 - first / 2; p += first) {
      const double length =
          distribution_.quantile(p + first / 2) - distribution_.quantile(p - first / 2);
      highest = std::max(highest, first / length);
    }
    const double finer = at_bound / highest;
    return finer < alike * std::min(1.0, ratio) ? finer : ratio;
  }

  const QuantityDistribution& distribution_;
  double finest_;
  double width_;
  double highest_ = 0;
};

}  // namespace

Check bounds(const Posterior& posterior, const Fit& fit) {
  constexpr double warns_above = 0.3, fails_above = 0.6;
  // Cells of nodes in the tails are coarse; for draws at least ten are needed.
  const double finest =
      fit.exact ? 1e-5
                : 10 / static_cast<double>(std::max<Eigen::Index>(1, fit.pooled.values.rows()));
  Findings findings("bounds");
  // For each parameter at its lower and its upper bound.
  std::vector<std::array<double, 2>> ratios(posterior.parameters().size());
  tbb::parallel_for(std::size_t{0}, ratios.size(), [&](std::size_t i) {
    const Distribution& prior = posterior.parameters()[i].prior;
    if (!std::isfinite(prior.lower) && !std::isfinite(prior.upper)) return;
    const RelativeDensity density(fit.marginals[i], finest);
    if (std::isfinite(prior.lower)) ratios[i][0] = density.above(prior.lower);
    if (std::isfinite(prior.upper)) ratios[i][1] = density.below(prior.upper);
  });
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const Parameter& parameter = posterior.parameters()[i];
    for (const bool lower : {true, false}) {
      const double bound = lower ? parameter.prior.lower : parameter.prior.upper;
      const double ratio = ratios[i][lower ? 0 : 1];
      if (!std::isfinite(bound) || ratio < warns_above) continue;
      const bool natural = bound == (lower ? parameter.natural_lower : parameter.natural_upper);
      findings.add(
          ratio >= fails_above && !natural ? dependence_on(parameter) : Verdict::warn,
          fmt::format("the density of {} at its {}{} bound {} is {:.0f} % of its highest",
                      parameter.name, natural ? "physical " : "", lower ? "lower" : "upper",
                      in_unit(parameter, bound), 100 * std::min(1.0, ratio)),
          natural ? fmt::format("The data do not distinguish {} from its bound.", parameter.name)
                  : fmt::format("The results depend on the bound of {}. If the bound is not prior "
                                "knowledge, move it.",
                                parameter.name));
    }
  }
  return findings.result("no parameter accumulates at a bound");
}

namespace {

// The probit of a prior's cdf, accurate to tails of about 1e-12; beyond, -7 or 7.
double score_of(const Distribution& distribution, double x) {
  double low = -7, high = 7;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (quantile(distribution, normal_cdf(middle)) < x ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Whether a prior ends on this side with a high density. It then does not contradict values there,
// as a half-normal prior of a scatter does not contradict a small one.
bool ends_high(const Distribution& distribution, bool lower) {
  constexpr int stations = 400;
  constexpr double high = 0.01;
  if (!std::isfinite(lower ? distribution.lower : distribution.upper)) return false;
  double highest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < stations; ++i)
    highest = std::max(
        highest, log_density(distribution, quantile(distribution, (i + 0.5) / stations)).value);
  constexpr double end = 1e-12;
  return log_density(distribution, quantile(distribution, lower ? end : 1 - end)).value >=
         highest + std::log(high);
}

// A posterior on the scale on which its prior is standard normal: its standard deviation (1 without
// information in the data, 0 for an improper prior), and the two-sided prior predictive probability
// of the data's estimate.
struct AgainstPrior {
  double width = 0, p_value = 1;
};

// If the prior is correct, the posterior mean m with posterior variance v has variance 1 - v, by
// the law of total variance. So m / sqrt(1 - v) is standard normal for a normal likelihood; it is
// the distance between prior and likelihood in units of their common standard deviation. The p
// value is 1 if the prior excludes nothing on that side.
AgainstPrior against_prior(const Distribution& distribution, std::vector<double> draws) {
  constexpr double least_learned = 0.05;  // lower limit of 1 - v, which 4000 draws estimate to
                                          // sqrt(2/4000) = 0.022
  if (!distribution.proper) return {};
  const auto score = [&](double share) {
    const auto at = draws.begin() + static_cast<std::ptrdiff_t>(share * double(draws.size()));
    std::nth_element(draws.begin(), at, draws.end());
    return score_of(distribution, *at);
  };
  const double median = score(0.5);
  const double sd = 0.5 * (score(0.84134) - score(0.15866));
  if (ends_high(distribution, median < 0)) return {sd, 1};
  const double distance = std::abs(median) / std::sqrt(std::max(1 - sd * sd, least_learned));
  return {sd, std::erfc(distance / std::numbers::sqrt2)};
}

// The draws about each maximum that has any, if there are several; the data are compatible with
// each of them.
std::vector<std::vector<Eigen::Index>> draws_by_maximum(const Posterior& posterior,
                                                        const Fit& fit) {
  constexpr double least = 0.05;
  if (!fit.maxima.several()) return {};
  const MaximaMixture mixture = counting_mixture(fit.maxima);
  std::vector<std::vector<Eigen::Index>> groups(mixture.size());
  const Eigen::Index count = fit.pooled.values.rows();
  for (Eigen::Index row = 0; row < count; ++row) {
    const Eigen::VectorXd x = fit.pooled.values.row(row);
    const Eigen::VectorXd z = posterior.to_real(view(x));
    groups[mixture.nearest(view(z))].push_back(row);
  }
  std::erase_if(groups, [&](const auto& group) {
    return static_cast<double>(group.size()) < least * static_cast<double>(count);
  });
  return groups;
}

}  // namespace

Check prior_data_conflict(const Posterior& posterior, const Fit& fit) {
  constexpr double excluded = 2.7e-3, far_out = 1e-2;  // three standard deviations, and 2.6
  constexpr double hardly_narrower = 0.7;              // data and prior are equally informative
  Findings findings("prior-data-conflict");
  const Eigen::MatrixXd& values = fit.pooled.values;
  std::vector<double> log_prior(static_cast<std::size_t>(values.rows())),
      log_likelihood(log_prior.size());
  tbb::parallel_for(std::size_t{0}, log_prior.size(), [&](std::size_t row) {
    const Eigen::VectorXd x = values.row(static_cast<Eigen::Index>(row));
    double of_effects = 0;
    for (std::size_t i = 0; i < posterior.parameters().size(); ++i) {
      const Parameter& each = posterior.parameters()[i];
      if (each.of_model) {
        of_effects += log_density(each.prior, x[static_cast<Eigen::Index>(i)]).value;
      }
    }
    log_prior[row] = posterior.log_prior(view(x)) - of_effects;
    log_likelihood[row] = posterior.likelihood()->value(view(x)) + of_effects;
  });
  const auto groups = draws_by_maximum(posterior, fit);
  std::vector<std::string> passed;
  for (std::size_t i = 0; i < posterior.parameters().size(); ++i) {
    const Parameter& parameter = posterior.parameters()[i];
    if (parameter.of_model) continue;
    const Eigen::VectorXd draws = values.col(static_cast<Eigen::Index>(i));
    const PowerScaling sensitivity = power_scaling(view(draws), log_prior, log_likelihood);
    const std::string numbers =
        fmt::format("{}: sensitivity to the prior {:.3f}, to the likelihood {:.3f}", parameter.name,
                    sensitivity.prior, sensitivity.likelihood);
    const PowerScalingVerdict scaling = verdict(sensitivity);
    if (scaling == PowerScalingVerdict::unknown) {
      findings.add(Verdict::warn, fmt::format("{}: unknown", parameter.name),
                   "The draws are not finite or all equal.");
      continue;
    }
    auto [width, p] = against_prior(parameter.prior, {draws.begin(), draws.end()});
    // A prior that is compatible with one of several maxima does not contradict the data.
    for (const std::vector<Eigen::Index>& group : groups) {
      const Eigen::VectorXd some = draws(group);
      p = std::max(p, against_prior(parameter.prior, {some.begin(), some.end()}).p_value);
    }
    if (p < far_out) {
      findings.add(p < excluded ? Verdict::fail : Verdict::warn,
                   fmt::format("{}; its prior {} the estimate from the data: tail probability {}",
                               numbers, p < excluded ? "excludes" : "barely allows",
                               p < 1e-11 ? "less than 1e-11" : fmt::format("{:.1g}", p)),
                   fmt::format("Prior and data contradict each other about {}. Check whether the "
                               "prior describes this component and these conditions, and check the "
                               "units of the prior and of the data.",
                               parameter.name));
    } else if (scaling == PowerScalingVerdict::none) {
      passed.push_back(numbers);
    } else if (parameter.is_default) {
      findings.add(Verdict::warn, numbers,
                   fmt::format("With so few data the default prior of {} influences the results: "
                               "state your own prior, or test more.",
                               parameter.name));
    } else if (width > hardly_narrower) {
      findings.add(
          Verdict::warn, numbers,
          fmt::format(
              "The posterior of {} is mostly its prior: the data narrow it by only {:.0f} %.",
              parameter.name, std::max(0.0, 100 * (1 - width))));
    } else {
      passed.push_back(numbers + " (prior and data both contribute, and agree)");
    }
  }
  return findings.result(fmt::format("{}", fmt::join(passed, "; ")));
}

}  // namespace wearwell
