#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

struct ExactSettings {
  double tolerance = 1e-5;     ///< of mass and second moments, relative
  bool second_moments = true;  ///< false: the posterior has none, so only its mass is integrated
  bool cells = true;           ///< false: nodes only for sums, not for distributions (lattice.h)
  long max_evaluations = 20'000'000;
  /// The better chart of a lattice, if known from a nearly equal posterior.
  std::optional<bool> along_ridge = {};
  std::stop_token stop = {};  ///< once requested, the integration throws `Cancelled`
  /// Other local maxima than that of the whitening (maxima.h), on the real line; the region must
  /// cover them.
  std::vector<Mode> maxima = {};
};

/// The maximum number of parameters for quadrature.
inline constexpr int max_exact_dimension = 4;

/// A posterior normalized by adaptive quadrature: no sampling, so no Monte Carlo error.
struct ExactPosterior {
  WeightedDraws nodes;
  Eigen::VectorXd mean;  ///< natural, SI; NaN if the moment does not exist
  Eigen::VectorXd sd;
  Eigen::MatrixXd covariance;
  std::optional<double>
      log_evidence;  ///< log of the integral of likelihood x prior; only if every prior is proper
  double log_mass = 0;  ///< log of the integral of likelihood x prior kernels
  double error = 0;     ///< estimated relative error of mass and second moments
  double highest = 0;   ///< log density (on the real line) of the highest node
  long evaluations = 0;
  bool along_ridge = false;   ///< its lattice follows the ridge of a funnel (lattice_chart.h)
  std::string failure;        ///< empty if the mass converged; else the reason, and the nodes are
                              ///< unreliable
  bool contradicted = false;  ///< it failed the comparison with the walk along the ridge
};

/// Integrates a posterior with up to `max_exact_dimension` parameters: four parameters on a lattice
/// (lattice.h); fewer, or without convergence, by adaptive boxes. Works on the whitened real line,
/// along the ridge for a funnel or a curved posterior (ridge_map.h). Boxes are halved along the
/// worst-resolved axis until the estimated error of mass and second moments is below the tolerance,
/// and the region grows where its edge still has mass or second moments. Boxes must agree on the
/// density at shared faces, and each relevant box is inspected between its nodes; differences raise
/// the error. Several maxima are covered from the beginning by boxes of at most a few widths; with
/// four parameters each maximum is integrated separately (parted_posterior.h). The result is
/// compared with the walk along the ridge: a higher density than that of any node, or a very
/// different Laplace approximation of the integral, is a failure.
ExactPosterior integrate(const Posterior& posterior, const Whitening& whitening,
                         const ExactSettings& settings = {});

/// The same along the ridge of `shape`, a similar posterior (of all observations, if this one omits
/// one and has no gradient).
ExactPosterior integrate(const Posterior& posterior, const Whitening& whitening,
                         const ExactSettings& settings, const Posterior& shape);

/// Independent draws from the exact posterior: `chains` x `draws`, with one random stream per
/// chain.
Draws independent_draws(const Posterior& posterior, const ExactPosterior& exact, int chains,
                        int draws, std::uint64_t seed, std::uint64_t first_stream);

}  // namespace wearwell
