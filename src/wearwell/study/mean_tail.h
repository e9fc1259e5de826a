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

/// From here on the mean is reported as not finite: its sum over the posterior is one of few points, and more points
/// would make it larger. It is the limit of a lognormal posterior with a standard deviation of the logarithm of 2.3,
/// whose 90 % interval spans a factor of 2000.
inline constexpr double most_of_finite = 0.5;
inline constexpr const char* not_finite_text = "not finite";

/// The share of the mean of |value| that its highest 1 % of the probability carries; 1 if that mean is
/// infinite, none without a distribution or if all values are 0.
std::optional<double> share_of_highest(const QuantityDistribution& value);

/// The same of a positive value; 1 where its mean is infinite.
double share_of_highest(const CellMixture& value);

/// Makes a posterior mean infinite whose tail carries more than `most_of_finite` of it; quantiles stay.
void refuse_endless_mean(QuantityQuantiles& q);
/// Whether a mean with a known tail is reported as not finite.
bool is_endless_mean(const QuantityQuantiles& q);
/// Why, as a clause; empty if the mean is finite.
std::string reason_of_endless_mean(const QuantityQuantiles& q);

/// What a reader should know of the means among these quantities that rest on the tail, as sentences.
/// `bounds`: of the design values, else of the others.
std::vector<std::string> mean_tail_remarks(const std::vector<QuantitySummary>& quantities,
                                           bool bounds);

/// The check `mean-life`; none without a mean whose tail is known.
std::optional<Check> mean_life_check(const std::vector<QuantitySummary>& quantities);

}  // namespace wearwell
