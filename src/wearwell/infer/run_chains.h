#pragma once

#include <optional>
#include <span>

#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/maxima.h"
#include "wearwell/infer/settings.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

struct NutsSettings {
  bool dense_metric = false;
  double target_accept =
      0.9;  ///< of the mean transition; higher is slower and safer in skewed posteriors
  int max_treedepth = 10;
};

/// Independent NUTS chains on the whitened real line, from starts spread over several posterior
/// widths. Where there are several `maxima`, chains start about each of them in turn, and before each transition a chain may jump
/// to a place drawn from Student distributions about the maxima, by the rule of Metropolis and Hastings.
Draws run_nuts(const Posterior& posterior, const Whitening& whitening, const NutsSettings& nuts,
               const RunSettings& settings, std::span<const LocalMaximum> maxima = {});

struct MetropolisSettings {
  std::optional<Eigen::VectorXd>
      half_width;  ///< of the proposals, SI; without it warm-up finds directions and length
};

/// Independent Metropolis-Hastings chains from starts as for NUTS: on the natural parameters with
/// the half widths that are given, else on the whitened real line. They do not jump.
Draws run_metropolis(const Posterior& posterior, const Whitening& whitening,
                     const MetropolisSettings& metropolis, const RunSettings& settings,
                     std::span<const LocalMaximum> maxima = {});

}  // namespace wearwell
