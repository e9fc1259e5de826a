#pragma once

#include "wearwell/infer/exact.h"

namespace wearwell {

/// Integrates the posterior as a sum of parts, one about each local maximum (the whitening's center
/// and `settings.maxima`): the density times the share of one component in a mixture of Student
/// distributions about the maxima. The shares are smooth and sum to 1, so every part is a smooth
/// density with one relevant maximum, which a lattice can integrate (lattice.h). Nodes and moments
/// combine all parts.
ExactPosterior integrate_by_parts(const Posterior& posterior, const Whitening& whitening,
                                  const ExactSettings& settings);

}  // namespace wearwell
