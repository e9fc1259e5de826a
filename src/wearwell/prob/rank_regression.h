#pragma once

#include <optional>
#include <span>
#include <vector>

#include "wearwell/prob/response.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {

/// How a rank becomes a share that has failed: the median of its beta distribution, or Benard's
/// approximation (rank - 0.3)/(n + 0.4).
enum class MedianRanks { exact, benard };

/// A failed item with its rank among all n items and the share that has failed by then.
struct RankedFailure {
  double at = 0;
  double rank = 0;  ///< from 1 to n; between whole numbers after a run-out
  double p = 0;
};

/// Failures in ascending order with the adjusted ranks of Johnson (1964): a run-out spreads its rank
/// over the failures after it. Items that fail at one life have a rank each; at one life run-outs
/// come after failures. Exact lives and run-outs only, without delayed entries. `counts` is the
/// number of items per observation.
std::vector<RankedFailure> ranked_failures(std::span<const Response> responses,
                                           std::span<const int> counts, MedianRanks method);

/// The line location + scale z through the failures on probability paper, where z is the quantile
/// of their shares: least squares of the lives (or their logarithms) on z, "X on Y" (Abernethy
/// 2006, ch. 2).
struct RankRegression {
  double location = 0, scale = 0;
  double r = 0;  ///< the correlation of lives and z
};

/// None if fewer than two lives differ.
std::optional<RankRegression> rank_regression(std::span<const RankedFailure> failures,
                                              StandardDistribution distribution, bool logarithmic);

/// The parameters of the family, in its order, of this line; none if the family is not one of two
/// parameters that is straight on its paper.
std::optional<std::vector<double>> family_parameters_of(ResponseFamily family,
                                                        const RankRegression& line);

}  // namespace wearwell
