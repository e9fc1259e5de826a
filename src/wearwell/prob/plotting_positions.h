#pragma once

#include <span>
#include <vector>

#include "wearwell/prob/response.h"

namespace wearwell {

/// Plotting positions on probability paper: a nonparametric estimate of the fraction p failed by
/// `at`.
struct PlottingPosition {
  double at, p;
};

/// For exact lives, run-outs and delayed entries: the Kaplan-Meier estimate, at the middle of each
/// step (Meeker and Escobar 1998, sec. 6.4), which is (i - 1/2)/n for n lives without run-outs.
/// With interval- or left-censored lives: Turnbull's estimate (1976), at the upper ends of the
/// intervals with a step. Run-outs have no position. `counts` is the number of items per
/// observation. Empty without failures, or if intervals and delayed entries occur together.
std::vector<PlottingPosition> plotting_positions(std::span<const Response> responses,
                                                 std::span<const int> counts);

}  // namespace wearwell
