#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace wearwell {

/// A test of independent standard normal residuals as a standard normal number: exact for them, and 0 where there
/// are too few. Such numbers can be averaged over draws of a posterior (`combined_p`).
///
/// Small where the residuals are not of one normal distribution, whatever its mean and width: the Anderson-Darling
/// test with both estimated. With scores as residuals, of whatever family, this is the test of Chen and Balakrishnan
/// (1995, J. Quality Technology 27, 154-161).
double shape_score(std::span<const double> z);

/// The sizes |z| of residuals as standard normal numbers, Phi^-1(2 Phi(|z|) - 1): exact for standard normal z.
std::vector<double> sizes(std::span<const double> z);

/// Large where `size` (of `sizes`) grows with `along`, small where it falls (Student's t): a score test of scatter that
/// follows it.
double scatter_trend_score(std::span<const double> size, std::span<const double> along);

/// Small where the sizes differ between levels (analysis of variance; Levene's test on the scale of `sizes`).
double scatter_between_score(std::span<const double> size, std::span<const std::size_t> level);

/// Large where residuals share an offset that a line through zero along `driver` does not take up (Student's t).
double offset_score(std::span<const double> z, std::span<const double> driver);

/// Where each value stands among those of its group: ranks, equal ones at their middle, less their mean. `group` may be
/// empty.
std::vector<double> centered_ranks(std::span<const double> values,
                                   std::span<const std::size_t> group);

/// The p value of what draws of a posterior say of one data set. Under a right law the score of each draw is standard
/// normal, and draws share the data: their mean has the variance 1 - v, v the variance between draws. It is divided by the
/// root of 1 - `credited` v, and of no less than 1/2, so that data of which little is seen accuse nothing. `credited` is 1
/// where scores of draws are nearly jointly normal, and smaller where they have longer tails.
double combined_p(std::span<const double> scores, bool two_sided, double credited = 1);

}  // namespace wearwell
