#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/diagnostics.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/maxima.h"
#include "wearwell/infer/run_chains.h"
#include "wearwell/infer/settings.h"
#include "wearwell/infer/stage.h"
#include "wearwell/infer/tail.h"

namespace wearwell {

/// How draws are made: independently from the exact posterior by quadrature, by NUTS, or by random-walk Metropolis.
enum class Method { exact, nuts, metropolis };

/// How a posterior is fitted.
struct FitSettings {
  Method method = Method::nuts;
  RunSettings run;
  NutsSettings nuts;
  MetropolisSettings metropolis;
  ExactSettings exact;
  /// Without quadrature, repeats unmixed draws with twice the number and warm-up, up to twice.
  bool extend = false;
  /// Draws that disagree with quadrature are repeated once with other random numbers; correct draws
  /// with this probability.
  double redraw_level = 1e-4;
};

/// A posterior as one method drew it, and beside it the exact one where quadrature can reach. Parameters are in their order in
/// the posterior, in SI.
struct Fit {
  Method method;  ///< as requested; NUTS if quadrature is requested but impossible
  Whitening whitening;
  std::vector<Tail> tails;  ///< two a parameter
  std::optional<ExactPosterior> exact;
  std::string no_exact;  ///< why there is no exact posterior; empty if there is one
  Draws draws;
  WeightedDraws pooled;                  ///< all draws of all chains, equally weighted
  std::vector<Diagnostics> diagnostics;  ///< of the draws, one per parameter
  std::vector<QuantityDistribution>
      marginals;          ///< of each parameter, SI: by quadrature, else from draws
  int max_treedepth = 0;  ///< limit for NUTS
  std::vector<StageDiagnostic> stage_diagnostics = {};  ///< shortfalls of all stages
  RunSettings run = {};  ///< of the draws; longer than requested if settings `extend`
  /// A polynomial surrogate of the posterior for many observations (surface.h), for evaluations at
  /// nodes and draws.
  std::shared_ptr<const Posterior> quick = {};
  double quick_error = 0;
  /// The maxima found from many starts (maxima.h), with shares by quadrature, else from draws;
  /// empty without a mode or finite mass.
  Maxima maxima = {};

  /// The other local maxima than that of the whitening, for integrals of similar posteriors.
  std::vector<Mode> other_maxima() const;
  bool redrawn = false;  ///< the first draws disagreed with quadrature
};

/// Whether the draws pass the checks of convergence and divergences (sampler_checks.h).
bool mixed(const Fit& fit);

/// The draws of one parameter for diagnostics: views, valid during the lifetime of the draws.
Chains chains_of(const Draws& draws, Eigen::Index parameter);

/// Whether every tail of every parameter is integrable.
bool proper(const Fit& fit);

/// Why quadrature is impossible for this number of parameters; empty if it is possible.
std::string beyond_quadrature(std::size_t parameters);

/// Finds the mode, examines the tails, searches for other local maxima, integrates exactly when there are at most
/// `max_exact_dimension` parameters and the posterior is proper, and draws. What a stage does not reach is in `stage_diagnostics`, not
/// thrown; ask `trust_checks` before you use the numbers. Throws `Cancelled` when it is asked to stop.
Fit fit(const Posterior& posterior, const FitSettings& settings);

}  // namespace wearwell
