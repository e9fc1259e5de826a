#pragma once

#include "wearwell/infer/exact.h"

namespace wearwell {

/// `integrate` where only sums over the nodes are asked for (moments, means of functions), no distribution: of four
/// parameters the ends of cells, nine tenths of the work that follows a lattice, are left out.
ExactPosterior integrate_sums(const Posterior& posterior, const Whitening& whitening,
                              const ExactSettings& settings, const Posterior& shape);

}  // namespace wearwell
