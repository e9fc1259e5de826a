#pragma once

#include <span>
#include <vector>

#include "wearwell/prob/response.h"

namespace wearwell {

/// Where observations stand on probability paper: that share p of all has failed by `at`, as the data say
/// without any law.
struct PlottingPosition {
  double at, p;
};

/// Of exact lives, run-outs and lives seen from an entry on only: Kaplan and Meier's estimate, and at each
/// life half way up its step (Meeker and Escobar 1998, sec. 6.4), which of n lives without run-outs is
/// (i - 1/2)/n. Where some are known to an interval or to have ended before: Turnbull's (1976), at the
/// upper ends of the intervals where it has a step. Run-outs have no place. `counts` says how many each
/// stands for. Empty where there is no failure, or where intervals come together with entries.
std::vector<PlottingPosition> plotting_positions(std::span<const Response> responses,
                                                 std::span<const int> counts);

}  // namespace wearwell
