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
      0.9;  ///< target of the mean acceptance; higher is slower and safer in skewed posteriors
  int max_treedepth = 10;
};

/// Independent NUTS chains on the whitened real line, from starts spread over several posterior
/// widths. With several `maxima`, chains start about each of them in turn, and each transition is
/// preceded by an independence Metropolis-Hastings proposal from Student distributions about the
/// maxima.
Draws run_nuts(const Posterior& posterior, const Whitening& whitening, const NutsSettings& nuts,
               const RunSettings& settings, std::span<const LocalMaximum> maxima = {});

struct MetropolisSettings {
  std::optional<Eigen::VectorXd>
      half_width;  ///< of the proposals, SI; if empty, warm-up adapts directions and length
};

/// Independent Metropolis-Hastings chains with starts as for NUTS: on the natural parameters with
/// given half-widths, else on the whitened real line. Without proposals between maxima.
Draws run_metropolis(const Posterior& posterior, const Whitening& whitening,
                     const MetropolisSettings& metropolis, const RunSettings& settings,
                     std::span<const LocalMaximum> maxima = {});

}  // namespace wearwell
