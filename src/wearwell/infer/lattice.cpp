#include "wearwell/infer/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "wearwell/base/monitor.h"
#include "wearwell/infer/lattice_chart.h"
#include "wearwell/infer/lattice_error.h"
#include "wearwell/infer/lattice_lines.h"
#include "wearwell/infer/lattice_result.h"
#include "wearwell/infer/ridge_map.h"

namespace wearwell {
namespace {

using namespace lattice;

// The limit of evaluations, and the error that is accepted and reported if the limit is reached.
constexpr double good_enough = 1e-3, acceptable = 5e-3;
constexpr long most_nodes = 6'000'000;
// The relative log density at which a first lattice ends: two millionths of a normal posterior
// lie beyond.
constexpr double first_end = -16;
// Finer than sums require: with cells that suffice for sums, quantiles have errors of some
// hundredths of a standard deviation, which decrease with the fourth power of the step.
constexpr double widest_reported = 0.55;
constexpr double longest_on_line = 0.7;

Steps steps_of(double step) {
  return {step, step, step, std::min(step, longest_on_line)};
}

// A filled lattice, or the reason of its failure.
struct Filled {
  Lines lines;
  std::string failure;
  ErrorEstimates error_estimates;
  double error = INFINITY;  // infinite unless filled
  double end = 0;           // the relative log density at which it ends
  long evaluations = 0;     // of the last filling

  Filled(const Posterior& posterior, const LatticeChart& chart, const Axes& axes,
         const Steps& steps, double log_negligible, long most, const ExactSettings& settings)
      : lines(posterior, chart, axes, steps) {
    fill(log_negligible, most, settings);
  }

  void fill(double log_negligible, long most, const ExactSettings& settings) {
    const long before = lines.nodes();
    end = log_negligible;
    failure = lines.fill(log_negligible, most, settings.progress);
    evaluations = lines.nodes() - before;
    error = INFINITY;
    if (!failure.empty()) return;
    error_estimates = lattice::error_estimates(lines, settings.second_moments);
    error = error_estimates.steps + error_estimates.beyond;
  }
};

// Where the lattice has to end so that the mass beyond, about proportional to the density there,
// is at most `most`; its present end if it is.
double deeper_end(const Filled& filled, double most) {
  const double beyond = filled.error_estimates.beyond;
  return beyond > most ? filled.end - std::clamp(1.5 * std::log(beyond / most), 1.0, 4.0)
                       : filled.end;
}

// Stops above `enough_nodes`.
void deepen(Filled& filled, double most_beyond, long enough_nodes, const ExactSettings& settings) {
  while (filled.failure.empty() && filled.lines.nodes() <= enough_nodes &&
         deeper_end(filled, most_beyond) < filled.end)
    filled.fill(deeper_end(filled, most_beyond), most_nodes, settings);
}

// Refines each axis separately, so that a narrow axis does not refine the others. Errors decay as
// exp(-c/step), faster for coarse steps.
Steps next_steps(const Steps& steps, const ErrorEstimates& error_estimates, double tolerance,
                 const Steps& widest) {
  constexpr double share = 0.2, least = 1.15, most = 2.5, coarse = 0.6;
  Steps next;
  for (std::size_t a = 0; a < d; ++a) {
    const ErrorEstimate& error_estimate = error_estimates.along[a];
    const double too_much = std::log(error_estimate.lacks / (share * tolerance));
    const double faster = steps[a] > coarse ? 1.5 : 1;
    const double finer =
        1 + too_much / (-4 * faster * std::log(std::min(error_estimate.decay, 0.9)));
    const bool refined = too_much > 0 && error_estimates.steps > 0.5 * tolerance;
    const double step = refined ? steps[a] / std::clamp(finer, least, most) : steps[a];
    next[a] = std::min(widest[a], step);
  }
  return next;
}

double mean_step(const Steps& steps) {
  return std::pow(steps[0] * steps[1] * steps[2] * steps[3], 1.0 / d);
}

// Coordinates and a coarse lattice in them.
struct Coordinates {
  const LatticeChart* chart = nullptr;
  Axes axes;
  std::shared_ptr<Filled> coarse;
};

// The lattice with the least error, if it is acceptable, or the reason of its failure.
struct Refined {
  std::shared_ptr<Filled> best;
  std::string failure;  // empty if the error is below the tolerance
  long evaluations = 0;
};

constexpr double coarsest = 1;
constexpr double share_beyond = 0.5;   // of the tolerated error
constexpr double most_missing = 1e-3;  // beyond coarse lattices that are compared

// Refines and deepens until the error is at most `enough` and steps are at most `widest`.
Refined refine(const Posterior& posterior, const Coordinates& in, double enough,
               const Steps& widest, const ExactSettings& settings) {
  double end = in.coarse->end;
  bool may_deepen = true;
  std::shared_ptr<Filled> filled = in.coarse;
  Refined refined;
  double before = INFINITY, step_before = coarsest;
  for (Steps steps = steps_of(coarsest); refined.evaluations < settings.max_evaluations;) {
    if (settings.stop.stop_requested()) throw Cancelled();
    if (!filled)
      filled =
          std::make_shared<Filled>(posterior, *in.chart, in.axes, steps, end, most_nodes, settings);
    refined.evaluations += filled->evaluations;
    if (!filled->failure.empty()) {
      refined.failure = filled->failure;
      if (end == first_end) break;
      // Too many nodes in the tails; the mass beyond is then reported.
      end = first_end;
      may_deepen = false;
      if (refined.best == filled) refined.best.reset();
      filled.reset();
      continue;
    }
    const double error = filled->error;
    const bool accepted = error <= std::max(enough, acceptable);
    if (refined.best == filled && !accepted) refined.best.reset();
    const ErrorEstimates error_estimates = filled->error_estimates;
    if (accepted && !(refined.best && refined.best->error < error)) refined.best = filled;
    const bool fine = std::equal(steps.begin(), steps.end(), widest.begin(), std::less_equal<>());
    if (error <= enough && fine) {
      refined.failure.clear();
      break;
    }
    refined.failure = fmt::format("no convergence in {} evaluations", refined.evaluations);
    // With a kink or a jump errors decrease only by a power of the step; a refinement that exceeds
    // the evaluations is not started. A small change of the step shows no power.
    const double step = mean_step(steps);
    if (!std::isfinite(before) || step < 0.9 * step_before) {
      const double power = std::log(before / error_estimates.steps) / std::log(step_before / step);
      const bool hopeless =
          std::isfinite(before) &&
          (error_estimates.steps >= before || std::pow(error_estimates.steps / enough, 4 / power) *
                                                      static_cast<double>(refined.evaluations) >
                                                  static_cast<double>(settings.max_evaluations));
      before = error_estimates.steps;
      step_before = step;
      if (hopeless && refined.best && refined.best->error <= good_enough) break;
    }
    const Steps finer = next_steps(steps, error_estimates, enough, widest);
    if (may_deepen) end = deeper_end(*filled, share_beyond * enough);
    if (finer != steps) {
      steps = finer;
      filled.reset();
    } else if (end < filled->end) {
      filled->fill(end, most_nodes, settings);
    } else {
      break;
    }
  }
  return refined;
}

}  // namespace

ExactPosterior integrate_on_lattice(const Posterior& posterior, const Whitening& whitening,
                                    const ExactSettings& settings) {
  std::optional<RidgeMap> map;
  std::unique_ptr<const LatticeChart> straight, along;
  if (settings.along_ridge != true) straight = straight_chart(posterior, whitening);
  if (settings.along_ridge != false) {
    map.emplace(posterior, whitening);
    along = ridge_chart(*map);
  }
  // Error estimates of coarse lattices are several times too large.
  const bool coarse = settings.tolerance >= good_enough;
  const double enough = coarse ? 5 * settings.tolerance : settings.tolerance;
  const auto coarse_on = [&](const LatticeChart& chart, const Axes& axes, double end, long most) {
    return std::make_shared<Filled>(posterior, chart, axes, steps_of(coarsest), end, most,
                                    settings);
  };
  Coordinates in;
  in.chart = straight ? straight.get() : along.get();
  in.coarse = coarse_on(*in.chart, {}, first_end, most_nodes);
  if (!settings.along_ridge && !map->affine() && !(in.coarse->error <= enough)) {
    // Lattices compare if most of the mass lies within their ends. If the straight one is
    // expensive, the other is chosen unless it is, too; otherwise one with half as many nodes more
    // is not better.
    constexpr long few_nodes = 140'000;
    deepen(*in.coarse, most_missing, few_nodes, settings);
    const bool straight_fails = !in.coarse->failure.empty();
    const bool expensive = straight_fails || in.coarse->lines.nodes() > few_nodes;
    auto rounder = coarse_on(*along, {}, straight_fails ? first_end : in.coarse->end,
                             expensive ? few_nodes : in.coarse->lines.nodes() / 2 * 3);
    const auto cost = [](const Filled& filled) {
      return filled.error_estimates.steps * static_cast<double>(filled.lines.nodes());
    };
    if (rounder->failure.empty() && (expensive || cost(*rounder) < cost(*in.coarse))) {
      in.chart = along.get();
      in.coarse = std::move(rounder);
    }
  }
  deepen(*in.coarse, share_beyond * enough, most_nodes, settings);
  const Steps widest = steps_of(coarse ? coarsest : widest_reported);
  Refined refined;
  // Long tails take most nodes. If axes that end them soon do not converge, even ones remain.
  constexpr long long_tails = 20'000;
  if (in.coarse->failure.empty() && in.coarse->lines.nodes() > long_tails) {
    Coordinates stretched = in;
    stretched.axes = in.coarse->lines.stretched_axes();
    stretched.coarse =
        coarse_on(*in.chart, stretched.axes, in.coarse->end, in.coarse->lines.nodes() / 5 * 3);
    if (stretched.coarse->failure.empty())
      refined = refine(posterior, stretched, enough, widest, settings);
  }
  if (!refined.best || !refined.failure.empty()) {
    ExactSettings rest = settings;
    rest.max_evaluations -= refined.evaluations;
    Refined even = refine(posterior, in, enough, widest, rest);
    even.evaluations += refined.evaluations;
    const bool better = even.best && !(refined.best && refined.best->error < even.best->error);
    if (better || !refined.best) {
      refined = std::move(even);
    } else {
      refined.evaluations = even.evaluations;
    }
  }
  ExactPosterior exact;
  if (refined.best) {
    exact = result_of(refined.best->lines, settings.second_moments, settings.cells);
    exact.error = refined.best->error;
  } else {
    exact.failure = refined.failure;
  }
  exact.evaluations = refined.evaluations;
  exact.along_ridge = in.chart == along.get();
  return exact;
}

}  // namespace wearwell
