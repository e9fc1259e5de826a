#pragma once

#include <optional>
#include <span>

#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/maxima.h"
#include "wearwell/infer/settings.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// The No-U-Turn sampler (Hoffman and Gelman 2014; Betancourt 2017).
struct NutsSettings {
  bool dense_metric = false;  ///< adapt a full mass matrix, not a diagonal one
  double target_accept =
      0.9;  ///< of the mean transition; higher is slower and safer in skewed posteriors
  int max_treedepth = 10;  ///< at most 2^max_treedepth - 1 leapfrog steps a transition
};

/// Independent NUTS chains on the whitened real line, from starts spread over several posterior
/// widths. Returns `settings.chains` chains of `settings.draws` draws; throws `Cancelled` when it is
/// asked to stop. Where there are several `maxima`, chains start about each of them in turn, and before each transition a chain may jump
/// to a place drawn from Student distributions about the maxima, by the rule of Metropolis and Hastings.
Draws run_nuts(const Posterior& posterior, const Whitening& whitening, const NutsSettings& nuts,
               const RunSettings& settings, std::span<const LocalMaximum> maxima = {});

/// Random-walk Metropolis.
struct MetropolisSettings {
  std::optional<Eigen::VectorXd>
      half_width;  ///< of the proposals, SI; if empty, warm-up adapts directions and length
};

/// Independent Metropolis-Hastings chains from starts as for NUTS: on the natural parameters with
/// the half widths that are given, else on the whitened real line. They do not jump between maxima. Returns and
/// throws as run_nuts.
Draws run_metropolis(const Posterior& posterior, const Whitening& whitening,
                     const MetropolisSettings& metropolis, const RunSettings& settings,
                     std::span<const LocalMaximum> maxima = {});

}  // namespace wearwell
