#include "wearwell/infer/fit.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/infer/digits.h"
#include "wearwell/infer/mode.h"

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

Draws draw(const Posterior& posterior, const Fit& fit, const FitSettings& settings) {
  switch (fit.method) {
    case Method::exact:
      return independent_draws(posterior, *fit.exact, settings.run.chains, settings.run.draws,
                               settings.run.seed, settings.run.first_stream);
    case Method::metropolis:
      return run_metropolis(posterior, fit.whitening, settings.metropolis, settings.run);
    case Method::nuts:
      break;
  }
  return run_nuts(posterior, fit.whitening, settings.nuts, settings.run);
}

// The mode and the tails about it. A walk along a tail that meets a higher density than the mode's
// starts the search anew from there: sigma may lie 20 factors of e below where it was guessed.
struct Shape {
  Mode mode;
  std::vector<Tail> tails;
  double highest;  // density met anywhere
};

Shape examine(const Posterior& posterior) {
  constexpr int most_searches = 4;
  constexpr double higher = 0.01;
  Shape shape{find_mode(posterior, posterior.start()), {}, 0};
  for (int search = 1;; ++search) {
    shape.tails = tails(posterior, shape.mode);
    shape.highest = shape.mode.log_density;
    const Tail* best = nullptr;
    for (const Tail& tail : shape.tails) {
      if (tail.highest_at.size() == 0 || !(tail.highest > shape.highest)) continue;
      shape.highest = tail.highest;
      best = &tail;
    }
    if (!best || shape.highest < shape.mode.log_density + higher || search == most_searches) {
      return shape;
    }
    Mode next = find_mode(posterior, best->highest_at);
    if (!next.found || !(next.log_density > shape.mode.log_density)) return shape;
    shape.mode = std::move(next);
  }
}

std::vector<Shortfall> shortfalls(const Posterior& posterior, const Shape& shape,
                                  const FitSettings& settings, const Fit& fit,
                                  const ExactPosterior& integral) {
  std::vector<Shortfall> found;
  constexpr double most_above = 3;
  if (!shape.mode.found) {
    found.push_back({Stage::mode, fit.exact ? Verdict::warn : Verdict::fail,
                     fit.exact ? "there is none, or it was not found; quadrature vouches for the numbers"
                               : "there is none, or it was not found",
                     "Give priors that hold every parameter, or better guesses by their location."});
  } else if (fit.exact && shape.highest > fit.exact->highest + most_above) {
    found.push_back({Stage::quadrature, Verdict::fail,
                     fmt::format("a density e^{:.1f} times that of any node was met beside them",
                                 shape.highest - fit.exact->highest),
                     "There is more than one mode: cut the priors to the one that is meant."});
  }
  for (const Tail& tail : shape.tails) {
    if (tail.known) continue;
    const std::string& name =
        posterior.parameters()[static_cast<std::size_t>(tail.parameter)].name;
    found.push_back({Stage::tails, Verdict::fail,
                     fmt::format("how the posterior ends with {} {} could not be measured", name,
                                 tail.towards_bound ? "near its bound"
                                 : tail.upward      ? "large"
                                                    : "towards minus infinity"),
                     fmt::format("Bound {}, or give proper priors to all parameters.", name)});
  }
  const bool failed = !integral.failure.empty();
  if (integral.contradicted || (failed && settings.method == Method::exact)) {
    found.push_back({Stage::quadrature, Verdict::fail, integral.failure,
                     "The numbers are a sampler's. Narrower priors make the posterior rounder."});
  } else if (fit.exact && fit.exact->error > settings.exact.tolerance) {
    found.push_back({Stage::quadrature, Verdict::warn,
                     fmt::format("its relative error is {:.1g}, not {:.1g}", fit.exact->error,
                                 settings.exact.tolerance),
                     "Read no more digits than that."});
  }
  return found;
}

}  // namespace

Chains chains_of(const Draws& draws, Eigen::Index parameter) {
  Chains chains;
  for (const Chain& chain : draws) {
    chains.draws.emplace_back(chain.values.col(parameter).data(),
                              static_cast<std::size_t>(chain.values.rows()));
  }
  return chains;
}

Fit fit(const Posterior& posterior, const FitSettings& settings) {
  Shape shape = examine(posterior);
  Fit fit{settings.method,
          whitening_at(shape.mode),
          shape.tails,
          {},
          {},
          {},
          {},
          {},
          settings.nuts.max_treedepth};

  const auto all = [&](auto property) {
    return std::all_of(fit.tails.begin(), fit.tails.end(), property);
  };
  ExactPosterior integral;
  if (posterior.dimension() > max_exact_dimension) {
    fit.no_exact = fmt::format("{} parameters are more than quadrature reaches ({})",
                               posterior.dimension(), max_exact_dimension);
  } else if (!all([](const Tail& t) { return t.integrable(); })) {
    fit.no_exact = "the posterior is improper";
  } else {
    ExactSettings exact = settings.exact;
    exact.second_moments = all([](const Tail& t) { return t.has_moment(2); });
    integral = integrate(posterior, fit.whitening, exact);
    if (integral.failure.empty()) {
      fit.exact = std::move(integral);
      integral = {};
    } else {
      fit.no_exact = integral.failure;
    }
  }
  if (fit.method == Method::exact && !fit.exact) fit.method = Method::nuts;
  fit.draws = draw(posterior, fit, settings);
  fit.pooled = pool(fit.draws);
  for (int i = 0; i < posterior.dimension(); ++i) {
    fit.diagnostics.push_back(diagnose(chains_of(fit.draws, i)));
  }
  fit.shortfalls = shortfalls(posterior, shape, settings, fit, integral);
  for (Shortfall& each : digits(posterior, fit.whitening, fit.exact ? fit.exact->nodes : fit.pooled)) {
    fit.shortfalls.push_back(std::move(each));
  }
  return fit;
}

}  // namespace wearwell
