#pragma once

#include <optional>
#include <vector>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The share of the points of a posterior that is enough to see how far numbers depend on how many there are.
inline constexpr double fewer_points = 0.25;

/// Errors below are not worth a word: no digit that is printed shows them.
inline constexpr double least_numerical_error = 1e-4;

/// By how much two values of one number differ, relative to it; of a number far below `size` relative to a thousandth of that. 1 where one
/// of the two alone is finite.
double relative_difference(double value, double other, double size);

/// Sets QuantityQuantiles::numerical_error of each answer: twice the largest relative difference of its numbers from those of `coarse`, the
/// same over fewer_points. Where the error falls with the number of points that is far more than it is; twice, since now and then one of
/// few does not. Where an error of the quantiles is set it stays, and the predictive value alone is compared.
void estimate_numerical_errors(std::vector<QuantityQuantiles>& answers,
                               const std::vector<QuantityQuantiles>& coarse);

/// Of the lives among them, or of all others; none where all are below least_numerical_error.
std::optional<double> largest_numerical_error(const std::vector<QuantitySummary>& quantities,
                                              bool bounds);

}  // namespace wearwell
