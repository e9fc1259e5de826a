#pragma once

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// Scatter ranges in the definition of FKM and DIN 50100, 10 to 90 % of items: T_N of lives, T_S of
/// stresses, and the slope k; for each the 5, 50 and 95 % quantile of the posterior. Dimensionless.
struct ScatterRange {
  double n05, n50, n95, s05, s50, s95, k05, k50, k95;
};

/// For a curve with a slope, Basquin's or one with a knee, whose lives scatter on a logarithmic
/// scale.
ScatterRange scatter_range(const SnLaw& law, const WeightedDraws& draws);

}  // namespace wearwell::fatigue
