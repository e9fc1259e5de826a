#pragma once

#include "wearwell/infer/exact.h"
#include "wearwell/infer/lattice_lines.h"

namespace wearwell::lattice {

/// Moments and nodes. Without cells the nodes are valid only for sums.
ExactPosterior result_of(const Lines& lines, bool moments, bool with_cells);

}  // namespace wearwell::lattice
