#pragma once

#include "wearwell/bayes/draws.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/run_chains.h"

namespace wearwell {

/// NUTS and leaps in turn, for posteriors that bend so much that NUTS alone takes long to walk around them: before each
/// transition a chain may leap eight times to a place that is proposed without regard to where it stands, by the rule of
/// Metropolis and Hastings (an independence sampler; Tierney 1994, section 2.3). Proposed is a mixture: Student laws about
/// six hundred draws of earlier chains, narrow and three times as wide, and one about all with long tails. Transitions are
/// cut short at seven steps: what they are for is what the mixture does not reach. A mixture about `pilot`, draws that lie
/// about right, serves for 300 draws a chain; about these lies the mixture of the draws that are kept. It is fixed before
/// the first of them, so that the posterior is the exact limit of the chains whatever the pilot. Where an evaluation takes
/// long (`LogDensity::is_slow`) it serves for 150, and leaps are as many as it takes to be elsewhere every second draw.
///
/// Chains start where those of the pilot ended. `settings.warmup` is not used: steps adapt in transitions of their own.
Draws run_independence(const Posterior& posterior, const Draws& pilot, const NutsSettings& nuts,
                       const RunSettings& settings);

/// `run_nuts`; or leaps about what warm-up has drawn, where its second quarter or its second half tells that as many
/// draws will hardly suffice: fewer than 125 effective ones a chain by their share there, or an R-hat above 1.05. Where an
/// evaluation takes long (`LogDensity::is_slow`) leaps about the second eighth of it: they take fewer.
Draws run_nuts_or_independence(const Posterior& posterior, const Whitening& whitening,
                               const NutsSettings& nuts, const RunSettings& settings);

}  // namespace wearwell
