#pragma once

#include <functional>
#include <span>

namespace wearwell {

struct Rise;

/// A p value for standard normal residuals, exact if independent; 1 if there are too few.
using ResidualTest = std::function<double(std::span<const double> z)>;

/// Tests the sum of squares (chi-squared, two-sided).
double scatter_test(std::span<const double> z);

/// Tests for a zero mean (Student's t, two-sided); independent of scale.
double location_test(std::span<const double> z);

/// Tests for correlation with `driver` (Student's t, two-sided); independent of scale.
double trend_test(std::span<const double> z, std::span<const double> driver);

/// Tests for positive correlation of neighbours: von Neumann's ratio of the mean squared successive
/// difference to the variance. Exact up to 40 values (Imhof 1961); beyond, a symmetric beta
/// distribution with the same range and variance. One-sided, independent of scale.
double neighbour_test(std::span<const double> z);

/// Tests the largest square as an outlier, with Bonferroni's bound, which is exact in the tail.
/// Independent of scale.
double extreme_test(std::span<const double> z);

/// One-sided Student's test for a decrease of the observed quantity with the driver, within groups:
/// exact for normal noise and a constant response, conservative for an increasing one.
double fall_test(const Rise& rise);

/// The same for a line through the origin: tests for negative observations.
double sign_test(const Rise& rise);

}  // namespace wearwell
