#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "wearwell/base/progress.h"
#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// How exact, and how far, quadrature goes.
struct ExactSettings {
  double tolerance = 1e-5;     ///< of mass and second moments, relative
  bool second_moments = true;  ///< false: the posterior has none, so only its mass is integrated
  bool cells = true;           ///< false: nodes for sums alone, not for distributions (lattice.h)
  long max_evaluations = 20'000'000;  ///< of the density; more is a failure
  /// The coordinates of a lattice in which the posterior is rounder, if a similar posterior has shown it.
  std::optional<bool> along_ridge = {};
  std::stop_token stop = {};     ///< once requested, the integration throws `Cancelled`
  Progress* progress = nullptr;  ///< receives every evaluation of the density; may be null
  /// Other local maxima than that of the whitening (maxima.h), on the real line; the region must
  /// cover them.
  std::vector<Mode> maxima = {};
};

/// The maximum number of parameters for quadrature.
inline constexpr int max_exact_dimension = 4;

/// A posterior normalized by adaptive quadrature: no sampling, so no Monte Carlo error.
struct ExactPosterior {
  WeightedDraws nodes;         ///< natural parameters, SI, with weights and cells
  Eigen::VectorXd mean;        ///< natural, SI; NaN where the moment does not exist
  Eigen::VectorXd sd;          ///< likewise
  Eigen::MatrixXd covariance;  ///< likewise, parameters x parameters
  std::optional<double>
      log_evidence;  ///< log of the integral of likelihood x prior; only if every prior is proper
  double log_mass = 0;  ///< log of the integral of likelihood x prior kernels
  double error = 0;  ///< estimated relative error of mass and second moments: the reached tolerance
  double highest = 0;         ///< log density (on the real line) of the highest node
  long evaluations = 0;       ///< of the density
  bool along_ridge = false;   ///< its lattice follows the ridge of a funnel (lattice_chart.h)
  std::string failure;        ///< empty when the mass converged; else what happened, without nodes
  bool contradicted = false;  ///< it failed because of what the walk along the ridge met
};

/// Integrates a posterior with up to `max_exact_dimension` parameters: four on a lattice
/// (lattice.h), fewer, or where that does not converge, by adaptive boxes. Works on the whitened real
/// line, along the ridge where the posterior opens like a funnel or bends (ridge_map.h): boxes are
/// halved along the axis that resolves worst until the estimated error of mass and second moments is
/// below the tolerance, and the region grows where mass or second moments still lie at its edge. Boxes
/// that share a face have to agree on the density there, and each that counts is inspected between its
/// nodes: what is found raises the error. Where there are several maxima, boxes cover all of them from the beginning, no longer than a
/// few of their widths about each; four parameters are integrated maximum by maximum (parted_posterior.h). The
/// outcome is held against what the walk along the ridge met: a higher density than that of any node,
/// or another integral by Laplace's approximation by far, is a failure. A failure is reported in
/// `failure`, not thrown; throws `Cancelled` when `settings.stop` asks for it.
ExactPosterior integrate(const Posterior& posterior, const Whitening& whitening,
                         const ExactSettings& settings = {});

/// The same along the ridge of `shape`, a similar posterior (of all observations, if this one omits
/// one and has no gradient).
ExactPosterior integrate(const Posterior& posterior, const Whitening& whitening,
                         const ExactSettings& settings, const Posterior& shape);

/// Independent draws from the exact posterior: `chains` chains of `draws` draws; chain c uses stream
/// `first_stream` + c of `seed`.
Draws independent_draws(const Posterior& posterior, const ExactPosterior& exact, int chains,
                        int draws, std::uint64_t seed, std::uint64_t first_stream);

}  // namespace wearwell
