#pragma once

#include <optional>
#include <vector>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The fraction of a posterior's points that suffices to estimate how results depend on the number
/// of points.
inline constexpr double fewer_points = 0.25;

/// Smaller errors are not reported; they do not affect printed digits.
inline constexpr double least_numerical_error = 1e-4;

/// The relative difference of two values of one number; for a number far below `size`, relative to
/// a thousandth of `size`. 1 if only one of the two is finite.
double relative_difference(double value, double other, double size);

/// Sets QuantityQuantiles::numerical_error of each answer to twice the largest relative difference
/// from `coarse`, the same numbers over fewer_points. This usually overestimates the error; the
/// factor of two covers the rare cases where it does not. An error that is already set for the
/// quantiles stays, and only the predictive value is compared.
void estimate_numerical_errors(std::vector<QuantityQuantiles>& answers,
                               const std::vector<QuantityQuantiles>& coarse);

/// The largest error of the lives, or of all other quantities; empty if all are below
/// least_numerical_error.
std::optional<double> largest_numerical_error(const std::vector<QuantitySummary>& quantities,
                                              bool bounds);

}  // namespace wearwell
