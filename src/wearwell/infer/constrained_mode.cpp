#include "wearwell/infer/constrained_mode.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "wearwell/infer/funnel.h"
#include "wearwell/infer/natural_density.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr int draws_to_start_from = 10;

// A maximum farther than this from the posterior, in its widths, is treated as an asymptote.
constexpr double far = 1e3;

// Curvature in units of the posterior's width below which a direction is a plateau.
constexpr double least_curvature = 1e-7;

// Curvature in units of the distance between two bounds below which the data are not informative.
constexpr double least_reported = 1e-3;

std::vector<Eigen::VectorXd> starts(const Posterior& posterior, const Fit& fit) {
  std::vector<Eigen::VectorXd> all;
  Eigen::VectorXd x(posterior.dimension());
  for (const Eigen::VectorXd& z : {posterior.start(), fit.whitening.center}) {
    posterior.to_natural(view(z), view(x));
    all.push_back(x);
  }
  const Chain* chain = nullptr;
  Eigen::Index row = 0;
  double most = -INFINITY;
  for (const Chain& each : fit.draws) {
    const auto highest = std::max_element(each.log_density.begin(), each.log_density.end());
    if (highest == each.log_density.end() || !(*highest > most)) continue;
    most = *highest;
    chain = &each;
    row = highest - each.log_density.begin();
  }
  if (chain) all.push_back(chain->values.row(row));
  const Points& draws = fit.pooled.values;
  for (Eigen::Index i = 0; i < draws_to_start_from; ++i) {
    all.push_back(draws.row((2 * i + 1) * draws.rows() / (2 * draws_to_start_from)));
  }
  return all;
}

constexpr const char* nowhere = "the search found no point of positive density";
constexpr const char* no_end = "the search did not converge";

std::string endless(const Parameter& parameter, bool lower) {
  return fmt::format("the density is unbounded as {} approaches its {} bound", parameter.name,
                     lower ? "lower" : "upper");
}

// Why the highest point found is not a mode; empty if it is one. `middle` is the center on the real
// line.
std::string problem_of(const Posterior& posterior, const Box& box, const Maximum& best,
                       const Eigen::VectorXd& middle, const Eigen::VectorXd& center,
                       const Eigen::VectorXd& width) {
  if (!std::isfinite(best.value)) return nowhere;
  for (Eigen::Index i = 0; i < best.x.size(); ++i) {
    const Parameter& parameter = posterior.parameters()[static_cast<std::size_t>(i)];
    const bool lower = best.x[i] <= box.lower[i], upper = best.x[i] >= box.upper[i];
    const double bound = lower ? parameter.prior.lower : parameter.prior.upper;
    // The exponent of a density that behaves like a power of the distance to the bound: log slope
    // times distance.
    if ((lower || upper) && std::abs(best.gradient[i] * (best.x[i] - bound)) > 0.01) {
      return endless(parameter, lower);
    }
    if (std::abs(best.x[i] - center[i]) > far * width[i]) {
      return fmt::format("the density still increases with {} at {:.3g} {}", parameter.name,
                         from_si(parameter.unit, best.x[i]), parameter.unit.text);
    }
  }
  if (best.converged) return {};
  // The search may diverge where the other parameters concentrate.
  for (int i = 0; i < posterior.dimension(); ++i) {
    if (!rises_without_end(posterior, middle, i)) continue;
    return endless(posterior.parameters()[static_cast<std::size_t>(i)], true);
  }
  return no_end;
}

}  // namespace

NaturalMode constrained_mode(const Posterior& posterior, const Fit& fit) {
  const Eigen::VectorXd width = natural_widths(posterior, fit.whitening);
  Eigen::VectorXd center(posterior.dimension());
  posterior.to_natural(view(fit.whitening.center), view(center));
  const NaturalDensity density(posterior);
  const Box box = natural_box(posterior, width);
  NaturalMode mode;
  const std::vector<Eigen::VectorXd> all = starts(posterior, fit);
  std::vector<Maximum> summits(all.size());
  std::vector<double> at_start(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    at_start[i] = density.value(view(all[i]));
    summits[i] = maximize(density, all[i], width, box);
    // Draws of an improper posterior may be at the limits of doubles.
    if (!(summits[i].value < INFINITY)) summits[i].value = -INFINITY;
    if (!(at_start[i] < INFINITY)) at_start[i] = -INFINITY;
  });
  const double highest_start = *std::max_element(at_start.begin(), at_start.end());
  const auto best =
      std::max_element(summits.begin(), summits.end(),
                       [](const Maximum& a, const Maximum& b) { return a.value < b.value; });
  mode.problem = problem_of(posterior, box, *best, fit.whitening.center, center, width);
  mode.fell_short = mode.problem == no_end || mode.problem == nowhere;
  mode.above_draws = best->value - highest_start;
  if (!mode.problem.empty()) return mode;

  mode.starts = static_cast<int>(summits.size());
  mode.reached =
      static_cast<int>(std::count_if(summits.begin(), summits.end(), [&](const Maximum& each) {
        return each.value > best->value - 1e-6 * (1 + std::abs(best->value));
      }));
  mode.position = best->x;
  mode.log_posterior = best->value;
  mode.log_likelihood = best->value - posterior.log_prior(view(best->x));
  mode.maximum = true;
  std::vector<Eigen::Index> inside;
  for (Eigen::Index i = 0; i < width.size(); ++i) {
    const Distribution& prior = posterior.parameters()[static_cast<std::size_t>(i)].prior;
    mode.maximum &= is_flat(prior);
    const bool lower = best->x[i] <= box.lower[i], upper = best->x[i] >= box.upper[i];
    mode.place.push_back(lower ? Place::lower_bound : upper ? Place::upper_bound : Place::inside);
    if (lower) mode.position[i] = prior.lower;
    if (upper) mode.position[i] = prior.upper;
    const double range = prior.upper - prior.lower;
    const bool known = std::abs(best->curvature(i, i)) * range * range < least_reported;
    if (!lower && !upper && !known) inside.push_back(i);
  }
  mode.standard_error =
      Eigen::VectorXd::Constant(width.size(), std::numeric_limits<double>::quiet_NaN());
  if (inside.empty()) return mode;
  const Eigen::VectorXd unit = width(inside);
  const Eigen::MatrixXd scaled =
      unit.asDiagonal() * best->curvature(inside, inside) * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  if (!(eigen.eigenvalues()[0] > least_curvature)) {
    Eigen::Index flat = 0;
    eigen.eigenvectors().col(0).cwiseAbs().maxCoeff(&flat);
    mode.problem = fmt::format(
        "the density is a plateau along {}",
        posterior.parameters()[static_cast<std::size_t>(inside[static_cast<std::size_t>(flat)])]
            .name);
    return mode;
  }
  mode.standard_error(inside) = scaled.inverse().diagonal().cwiseSqrt().cwiseProduct(unit);
  return mode;
}

}  // namespace wearwell
