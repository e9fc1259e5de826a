#include "wearwell/infer/fit.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "wearwell/infer/agreement.h"
#include "wearwell/infer/conditioning.h"
#include "wearwell/infer/effects.h"
#include "wearwell/infer/independence_sampler.h"
#include "wearwell/infer/maxima_mixture.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/posterior_shape.h"
#include "wearwell/infer/surface.h"

namespace wearwell {
namespace {

WeightedDraws pool(const Draws& draws) {
  Eigen::Index rows = 0;
  for (const Chain& chain : draws) rows += chain.values.rows();
  WeightedDraws pooled;
  pooled.values.resize(rows, draws.front().values.cols());
  pooled.weights = Eigen::VectorXd::Constant(rows, 1.0 / static_cast<double>(rows));
  Eigen::Index row = 0;
  for (const Chain& chain : draws) {
    pooled.values.middleRows(row, chain.values.rows()) = chain.values;
    row += chain.values.rows();
  }
  return pooled;
}

// The maxima about which chains start and between which they jump; the others have too little mass
// for any draw.
std::vector<LocalMaximum> maxima_to_draw(const Fit& fit) {
  constexpr double least = 1e-3;
  std::vector<LocalMaximum> kept;
  for (const LocalMaximum& each : fit.maxima.found) {
    if (each.share >= least) kept.push_back(each);
  }
  return kept;
}

Draws draw(const Posterior& posterior, const Fit& fit, const FitSettings& settings) {
  switch (fit.method) {
    case Method::exact:
      return independent_draws(posterior, *fit.exact, settings.run.chains, settings.run.draws,
                               settings.run.seed, settings.run.first_stream);
    case Method::metropolis:
      return run_metropolis(posterior, fit.whitening, settings.metropolis, settings.run,
                            maxima_to_draw(fit));
    case Method::nuts:
      break;
  }
  return run_nuts(posterior, fit.whitening, settings.nuts, settings.run, maxima_to_draw(fit));
}

std::vector<StageDiagnostic> stage_diagnostics(const Posterior& posterior,
                                               const PosteriorShape& shape,
                                               const FitSettings& settings, const Fit& fit,
                                               const ExactPosterior& integral) {
  std::vector<StageDiagnostic> found;
  constexpr double most_above = 3;
  if (!shape.mode.found) {
    found.push_back(
        {Stage::mode, fit.exact ? Verdict::warn : Verdict::fail,
         fit.exact ? "there is no mode, or it was not found; the numbers are those of quadrature"
                   : "there is no mode, or it was not found",
         "Give informative priors for all parameters, with locations near the expected values."});
  } else if (shape.neck >= 0) {
    const auto neck = static_cast<std::size_t>(shape.neck);
    found.push_back(
        {Stage::mode, fit.exact ? Verdict::warn : Verdict::fail,
         fmt::format("there is no mode: the density is unbounded as {} approaches its bound, where "
                     "samplers fail; {}",
                     posterior.parameters()[neck].name,
                     !fit.exact                      ? "quadrature is not available"
                     : fit.method == settings.method ? "the numbers are those of quadrature"
                                                     : "the draws are those of quadrature"),
         "Give more rows than parameters, or a measured scatter."});
  } else if (fit.exact && shape.highest > fit.exact->highest + most_above) {
    found.push_back(
        {Stage::quadrature, Verdict::fail,
         fmt::format("a density e^{:.1f} times that of any node exists between the nodes",
                     shape.highest - fit.exact->highest),
         "The posterior has more than one mode: restrict the priors to the intended one."});
  }
  if (fit.maxima.several() && !fit.exact && !mixed(fit)) {
    found.push_back({Stage::maxima, Verdict::fail,
                     fmt::format("{}; quadrature does not cover them, and the chains switch "
                                 "between them too rarely to estimate their shares",
                                 description(posterior, fit.maxima)),
                     "Restrict the priors to the intended maximum; order exchangeable parameters; "
                     "or draw many more (--draws, --warmup)."});
  }
  constexpr double most_left = 0.5;
  if (fit.maxima.left > most_left) {
    found.push_back({Stage::maxima, Verdict::warn,
                     fmt::format("{}; about {:.0f} more probably exist that no search has found",
                                 description(posterior, fit.maxima), std::ceil(fit.maxima.left)),
                     "Restrict the priors to possible values: the density has many local maxima."});
  }
  for (const Tail& tail : shape.tails) {
    if (tail.known) continue;
    const std::string& name = posterior.parameters()[static_cast<std::size_t>(tail.parameter)].name;
    found.push_back({Stage::tails, Verdict::fail,
                     fmt::format("the tail of the posterior for {} {} could not be measured", name,
                                 tail.towards_bound ? "near its bound"
                                 : tail.upward      ? "large"
                                                    : "towards minus infinity"),
                     fmt::format("Bound {}, or give proper priors to all parameters.", name)});
  }
  const bool failed = !integral.failure.empty();
  if (integral.contradicted || (failed && settings.method == Method::exact)) {
    found.push_back(
        {Stage::quadrature, Verdict::fail, integral.failure,
         "The numbers are those of a sampler. Narrower priors make quadrature easier."});
  } else if (fit.exact && fit.exact->error > settings.exact.tolerance) {
    found.push_back({Stage::quadrature, Verdict::warn,
                     fmt::format("its relative error is {:.1g} instead of {:.1g}", fit.exact->error,
                                 settings.exact.tolerance),
                     "Do not use more digits than that."});
  }
  return found;
}

}  // namespace

std::string beyond_quadrature(std::size_t parameters) {
  if (parameters <= max_exact_dimension) return "";
  return fmt::format("{} parameters exceed the limit of quadrature ({})", parameters,
                     max_exact_dimension);
}

bool proper(const Fit& fit) {
  return all_integrable(fit.tails);
}

Chains chains_of(const Draws& draws, Eigen::Index parameter) {
  Chains chains;
  for (const Chain& chain : draws) {
    chains.draws.emplace_back(chain.values.col(parameter).data(),
                              static_cast<std::size_t>(chain.values.rows()));
  }
  return chains;
}

std::vector<Mode> Fit::other_maxima() const {
  std::vector<Mode> others;
  for (std::size_t k = 1; k < maxima.found.size(); ++k) others.push_back(maxima.found[k].mode);
  return others;
}

bool mixed(const Fit& fit) {
  constexpr double largest_rhat = 1.01, most_divergent = 0.005;
  const double least = 100.0 * static_cast<double>(fit.draws.size());
  double divergent = 0, transitions = 0;
  for (const Chain& chain : fit.draws) {
    for (const NutsStep& step : chain.nuts) divergent += step.divergent;
    transitions += static_cast<double>(chain.nuts.size());
  }
  if (divergent > most_divergent * transitions) return false;
  return std::all_of(fit.diagnostics.begin(), fit.diagnostics.end(), [&](const Diagnostics& d) {
    return d.rhat <= largest_rhat && std::min(d.ess_bulk, d.ess_tail) >= least;
  });
}

namespace {

// Without quadrature and without a requested number of draws, insufficient draws are repeated with
// twice the length, up to twice; for NUTS first with independence proposals about the existing
// draws, which warm-up may already request. Draws of an improper posterior never suffice.
void draw_enough(const Posterior& posterior, const FitSettings& settings, Fit& fit) {
  constexpr int most_doublings = 2;
  FitSettings longer = settings;
  const bool independence = settings.extend && !fit.exact && proper(fit) &&
                            fit.method == Method::nuts && !fit.maxima.several();
  for (int doubling = 0;; ++doubling) {
    fit.run = longer.run;
    const bool continues = independence && doubling > 0;
    if (longer.run.progress && fit.method != Method::exact) {
      const long long each = longer.run.draws + (continues ? 0 : longer.run.warmup);
      longer.run.progress->begin("iterations", each * longer.run.chains);
    }
    fit.draws = !independence ? draw(posterior, fit, longer)
                : !continues
                    ? run_nuts_or_independence(posterior, fit.whitening, longer.nuts, longer.run)
                    : run_independence(posterior, fit.draws, longer.nuts, longer.run);
    fit.pooled = pool(fit.draws);
    fit.diagnostics.clear();
    for (int i = 0; i < posterior.dimension(); ++i) {
      fit.diagnostics.push_back(diagnose(chains_of(fit.draws, i)));
    }
    const bool may = settings.extend && !fit.exact && proper(fit) && doubling < most_doublings;
    if (!may || mixed(fit)) return;
    // Uses separate random streams, because the pilot has used the first ones.
    if (independence)
      longer.run.first_stream += 1ULL << 42;
    else
      longer.run.warmup *= 2;
    if (!independence || doubling > 0) longer.run.draws *= 2;
  }
}

// Among several statistics one is occasionally extreme by chance. Draws that disagree with reliable
// quadrature are repeated once; a fault of the sampler would reappear.
void redraw_where_they_disagree(const Posterior& posterior, FitSettings settings, Fit& fit) {
  constexpr double largest_error = 1e-3;
  if (!fit.exact || fit.method == Method::exact || !(fit.exact->error <= largest_error)) return;
  if (disagreements(fit, settings.redraw_level).empty()) return;
  settings.run.first_stream += 1ULL << 45;
  draw_enough(posterior, settings, fit);
  fit.redrawn = true;
}

}  // namespace

Fit fit(const Posterior& whole, const FitSettings& requested) {
  constexpr int most_slow_dimension = 2;
  // Trajectories through an improper posterior have no end, and their draws represent nothing.
  constexpr int most_improper_treedepth = 5;
  PosteriorShape shape = posterior_shape(whole);
  FitSettings settings = requested;
  if (!all_integrable(shape.tails))
    settings.nuts.max_treedepth = std::min(settings.nuts.max_treedepth, most_improper_treedepth);
  Fit fit{settings.method,
          whitening_at(shape.mode),
          shape.tails,
          {},
          {},
          {},
          {},
          {},
          {},
          settings.nuts.max_treedepth};

  fit.maxima = shape.maxima;
  // Polynomials cover only one maximum.
  if (shape.mode.found && shape.neck < 0 && !fit.maxima.several()) {
    if (auto quick = surrogate_posterior(whole, fit.whitening)) {
      fit.quick = quick->posterior;
      fit.quick_error = quick->error;
    }
  }
  const Posterior& posterior = fit.quick ? *fit.quick : whole;
  const auto all = [&](auto property) {
    return std::all_of(fit.tails.begin(), fit.tails.end(), property);
  };
  ExactPosterior integral;
  if (posterior.dimension() > max_exact_dimension) {
    fit.no_exact = beyond_quadrature(posterior.parameters().size());
  } else if (!all([](const Tail& t) { return t.integrable(); })) {
    fit.no_exact = "the posterior is improper";
  } else if (posterior.dimension() > most_slow_dimension && posterior.likelihood()->is_slow()) {
    fit.no_exact = fmt::format(
        "this likelihood integrates over paths or rates of use, which is too slow for quadrature "
        "over {} "
        "parameters",
        posterior.dimension());
  } else {
    ExactSettings exact = settings.exact;
    exact.maxima = fit.other_maxima();
    exact.second_moments = all([](const Tail& t) { return t.has_moment(2); });
    if (exact.progress) exact.progress->begin("evaluations of the density");
    integral = integrate(posterior, fit.whitening, exact);
    integral.error = std::max(integral.error, fit.quick_error);
    if (integral.failure.empty()) {
      fit.exact = std::move(integral);
      integral = {};
    } else {
      fit.no_exact = integral.failure;
    }
  }
  if (fit.method == Method::exact && !fit.exact) fit.method = Method::nuts;
  // A sampler hardly reaches the neck of a funnel or another maximum; draws are then taken from
  // quadrature.
  const bool spared = (shape.neck >= 0 || fit.maxima.several()) && fit.exact &&
                      fit.method == Method::nuts && settings.extend;
  if (spared) fit.method = Method::exact;
  draw_enough(posterior, settings, fit);
  if (fit.maxima.several())
    measure_shares(whole, fit.exact ? fit.exact->nodes : fit.pooled, fit.maxima);
  fit.stage_diagnostics = stage_diagnostics(whole, shape, settings, fit, integral);
  const WeightedDraws& points = fit.exact ? fit.exact->nodes : fit.pooled;
  fit.marginals.resize(posterior.parameters().size());
  tbb::parallel_for(std::size_t{0}, fit.marginals.size(), [&](std::size_t i) {
    fit.marginals[i] = QuantityDistribution(points, [i](const double* x) { return x[i]; });
  });
  redraw_where_they_disagree(posterior, settings, fit);
  for (StageDiagnostic& each : digits(whole, fit.whitening, points)) {
    fit.stage_diagnostics.push_back(std::move(each));
  }
  for (StageDiagnostic& each : unsettled_effects(whole, points)) {
    fit.stage_diagnostics.push_back(std::move(each));
  }
  return fit;
}

}  // namespace wearwell
