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
  /// Where no quadrature vouches for draws that have not mixed: twice as many with twice the warm-up, up to twice.
  bool extend = false;
  /// Draws that disagree with quadrature are drawn again once, with other random numbers: right ones with this probability.
  double redraw_level = 1e-4;
};

/// A posterior as one method drew it, and beside it the exact one where quadrature can reach. Parameters are in their order in
/// the posterior, in SI.
struct Fit {
  Method method;  ///< as asked for; NUTS where exact was asked for and cannot be
  Whitening whitening;
  std::vector<Tail> tails;  ///< two a parameter
  std::optional<ExactPosterior> exact;
  std::string no_exact;  ///< why there is no exact posterior; empty when there is one
  Draws draws;
  WeightedDraws pooled;                  ///< all draws of all chains, of one weight
  std::vector<Diagnostics> diagnostics;  ///< of the draws, one a parameter
  std::vector<QuantityDistribution>
      marginals;          ///< of each parameter, SI: by quadrature, or else by draws
  int max_treedepth = 0;  ///< that NUTS was allowed
  std::vector<StageDiagnostic> stage_diagnostics = {};  ///< what any stage did not reach
  RunSettings run = {};  ///< of the draws: longer than asked for where settings say `extend`
  /// The same posterior by polynomials, where observations are many (surface.h); what is done with nodes and
  /// draws may ask this one.
  std::shared_ptr<const Posterior> quick = {};
  double quick_error = 0;
  /// What the search from many starts found (maxima.h), with shares by quadrature, or else by the draws; empty where there is no mode
  /// or no finite mass.
  Maxima maxima = {};

  /// The local maxima beside the one that the whitening is about, for other integrals of much the same posterior.
  std::vector<Mode> other_maxima() const;
  bool redrawn = false;  ///< the first draws disagreed with quadrature
};

/// Whether the draws suffice, as the checks of convergence and divergences ask for it (sampler_checks.h).
bool mixed(const Fit& fit);

/// The draws of one parameter, as diagnostics take them: views, valid while the draws live.
Chains chains_of(const Draws& draws, Eigen::Index parameter);

/// Every tail of every parameter can be integrated.
bool proper(const Fit& fit);

/// Why quadrature is out of reach of so many parameters; empty where it is not.
std::string beyond_quadrature(std::size_t parameters);

/// Finds the mode, examines the tails, searches for other local maxima, integrates exactly when there are at most
/// `max_exact_dimension` parameters and the posterior is proper, and draws. What a stage does not reach is in `shortfalls`, not
/// thrown; ask `trust_checks` before you use the numbers. Throws `Cancelled` when it is asked to stop.
Fit fit(const Posterior& posterior, const FitSettings& settings);

}  // namespace wearwell
