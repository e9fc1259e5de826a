#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/check.h"
#include "wearwell/predict/cell_mixture.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// A mean rests on the upper tail if a larger share of it comes from lives beyond the longest observed
/// one, or if the highest 1 % of the posterior carries more of it. The second limit is that of a
/// lognormal posterior with a standard deviation of the logarithm of 1.5, whose 90 % interval spans
/// a factor of 130.
inline constexpr double most_beyond = 0.5, most_of_highest = 0.2;

/// The share of the mean of |value| that its highest 1 % of the probability carries; 1 if that mean is
/// infinite, none without a distribution or if all values are 0.
std::optional<double> share_of_highest(const QuantityDistribution& value);

/// The same of a positive value; 1 where its mean is infinite.
double share_of_highest(const CellMixture& value);

/// What a reader should know of the means among these quantities that rest on the tail, as sentences.
/// `bounds`: of the design values, else of the others.
std::vector<std::string> mean_tail_remarks(const std::vector<QuantitySummary>& quantities,
                                           bool bounds);

/// The check `mean-life`; none without a mean whose tail is known.
std::optional<Check> mean_life_check(const std::vector<QuantitySummary>& quantities);

}  // namespace wearwell
