#pragma once

#include "wearwell/infer/exact.h"

namespace wearwell {

/// The posterior as a sum of parts, one about each of its local maxima (the whitening's center and `settings.maxima`): its density
/// times the share that a mixture of Student distributions about the maxima gives to one of them. The shares are smooth and
/// sum to 1, so every part is a smooth density with one maximum of weight, which a lattice takes (lattice.h). Nodes and moments are
/// those of the parts together.
ExactPosterior integrate_by_parts(const Posterior& posterior, const Whitening& whitening,
                                  const ExactSettings& settings);

}  // namespace wearwell
