#pragma once

#include <functional>
#include <span>

namespace wearwell {

struct Rise;

/// A p value of standard normal residuals, exact for independent ones: 1 where there are too few.
using ResidualTest = std::function<double(std::span<const double> z)>;

/// The sum of squares is that of so many standard normals (chi squared, two-sided).
double scatter_test(std::span<const double> z);

/// The mean is zero (Student's t, two-sided): does not see their size.
double location_test(std::span<const double> z);

/// No correlation with `driver` (Student's t, two-sided): does not see their size.
double trend_test(std::span<const double> z, std::span<const double> driver);

/// Neighbours are not alike: von Neumann's ratio of the mean squared successive difference to the
/// variance. Exact up to 40 values (Imhof 1961); beyond, the symmetric beta law of the right range and
/// variance. From one side, does not see size.
double neighbour_test(std::span<const double> z);

/// The largest square is no outlier among the others: Bonferroni's bound, which is exact in the
/// tail. Does not see their size.
double extreme_test(std::span<const double> z);

/// Student's test, from one side, that the observed falls where the driver grows, within groups:
/// exact for normal noise where the law is level, and harder to pass the more it rises.
double fall_test(const Rise& rise);

/// The same of a line through the origin: the observed goes below zero.
double sign_test(const Rise& rise);

}  // namespace wearwell
