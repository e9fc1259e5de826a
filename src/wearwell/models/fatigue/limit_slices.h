#pragma once

#include <span>
#include <vector>

#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// Parts whose random fatigue limits lie close together: their share, and one score of the standard
/// distribution of log10 of the limit.
struct LimitSlice {
  double share, score;
};

/// The population of limits at parameters x, in slices within which lives under these stresses hardly
/// differ, or do not where a limit only decides whether a stress does damage (a knee). `index` moves
/// the slices from one point of a posterior to the next. `log10_reversed`: of the fully reversed
/// stresses [Pa].
std::vector<LimitSlice> slices_of_limits(const SnLaw& law, const double* x,
                                         std::span<const double> log10_reversed, std::size_t index);

}  // namespace wearwell::fatigue
