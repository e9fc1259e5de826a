#pragma once

#include <span>
#include <vector>

namespace wearwell {

/// A number of independent events at one point of a posterior: its mean, its variance (the mean for
/// a Poisson distribution, less for events of single units), and the weight of the point.
struct CountAtPoint {
  double mean = 0, variance = 0, weight = 0;
};

/// Quantiles of the mixture of counts over a posterior: for each of `probabilities` the smallest
/// whole number with at least this cumulative probability. The count at a point is Poisson
/// distributed where variance and mean agree, and else binomial with this mean and variance and a
/// number of trials that need not be whole. That is exact for units of equal probability; for
/// others the distance is of second order in the differences of their probabilities (Ehm 1991,
/// Statistics & Probability Letters 11, 7-16).
std::vector<double> count_quantiles(std::span<const CountAtPoint> points,
                                    std::span<const double> probabilities);

}  // namespace wearwell
