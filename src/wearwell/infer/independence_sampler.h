#pragma once

#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/run_chains.h"

namespace wearwell {

/// Alternates NUTS with independence Metropolis-Hastings proposals (Tierney 1994, section 2.3), for
/// strongly curved posteriors that NUTS alone explores slowly. Before each transition a chain makes
/// eight proposals that do not depend on its position. The proposal is a mixture: Student
/// distributions about six hundred draws of earlier chains, narrow and three times as wide, and one
/// with long tails about all. Transitions are limited to seven steps, because they are only needed
/// where the mixture does not reach. A mixture about `pilot`, approximately correct draws, is used
/// for 300 draws per chain; the mixture for the kept draws is built about these. It is fixed before
/// the first kept draw, so that the chains converge to the exact posterior for any pilot. For an
/// expensive likelihood (`LogDensity::is_slow`) it is used for 150 draws, and the number of
/// proposals is such that every second draw moves.
///
/// Chains start at the ends of the pilot's chains. `settings.warmup` is not used; steps adapt in
/// separate transitions.
Draws run_independence(const Posterior& posterior, const Draws& pilot, const NutsSettings& nuts,
                       const RunSettings& settings);

/// `run_nuts`, or independence proposals about the draws of warm-up, if its second quarter or
/// second half predicts that the draws will not suffice: fewer than 125 effective draws per chain,
/// or an R-hat above 1.05. For an expensive likelihood (`LogDensity::is_slow`) proposals about the
/// second eighth of warm-up, because they need fewer evaluations.
Draws run_nuts_or_independence(const Posterior& posterior, const Whitening& whitening,
                               const NutsSettings& nuts, const RunSettings& settings);

}  // namespace wearwell
