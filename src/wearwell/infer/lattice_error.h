#pragma once

#include <array>

#include "wearwell/infer/lattice_lines.h"

namespace wearwell::lattice {

/// The estimated error of sums over a lattice, relative to mass and second moments.
struct ErrorEstimate {
  double lacks = 0;  // from the size of the steps
  double decay =
      1;  // decay of the transform of the terms over the last quarter of the lattice's frequency
};
struct ErrorEstimates {
  std::array<ErrorEstimate, d> along{};  // for each axis, the worst direction that involves it
  double steps = 0;                      // of all directions
  double beyond = 0;                     // mass at the edge of the lattice
};

/// By the transforms of density and moments (only the density without `moments`), and the mass of
/// the outermost shells.
ErrorEstimates error_estimates(const Lines& lines, bool moments);

}  // namespace wearwell::lattice
