#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace wearwell {

/// A test of independent standard normal residuals as a standard normal score: exact, and 0 if
/// there are too few. Scores can be averaged over posterior draws (`combined_p`).
///
/// Small if the residuals are not from one normal distribution of any mean and width: the
/// Shapiro-Wilk test, and above `most_shapiro_wilk` residuals the Anderson-Darling test with both
/// estimated. Scores of any family may be residuals (Chen and Balakrishnan 1995, J. Quality
/// Technology 27, 154-161).
double shape_score(std::span<const double> z);

/// The sizes |z| of residuals as standard normal scores, Phi^-1(2 Phi(|z|) - 1): exact for standard
/// normal z.
std::vector<double> sizes(std::span<const double> z);

/// Large if `size` (from `sizes`) increases with `along`, small if it decreases (Student's t): a
/// score test of variable scatter.
double scatter_trend_score(std::span<const double> size, std::span<const double> along);

/// Small if the sizes vary between levels (analysis of variance; Levene's test on the scale of
/// `sizes`).
double scatter_between_score(std::span<const double> size, std::span<const std::size_t> level);

/// Large if residuals share an offset that a line through zero along `driver` does not explain
/// (Student's t).
double offset_score(std::span<const double> z, std::span<const double> driver);

/// Centered ranks within groups, with mean ranks for ties. `group` may be empty.
std::vector<double> centered_ranks(std::span<const double> values,
                                   std::span<const std::size_t> group);

/// The combined p value of the scores of posterior draws for one data set. For a correct model the
/// score of each draw is standard normal, and the mean over draws has variance 1 - v, with the
/// variance v between draws. The mean is divided by the root of 1 - `credited` v, at least root
/// 1/2, so that weak data do not cause rejections. `credited` is 1 if scores of draws are nearly
/// jointly normal, and smaller for longer tails.
double combined_p(std::span<const double> scores, bool two_sided, double credited = 1);

}  // namespace wearwell
