#pragma once

#include <span>
#include <vector>

namespace wearwell {

/// A place on a line and how much it counts.
struct WeightedPoint {
  double at = 0, weight = 0;
};

/// Gauss's rule of a discrete measure: at most `count` nodes of positive weights, over which the sum of every polynomial of a
/// degree below 2 `count` is that over the points (Gautschi 2004, Orthogonal Polynomials, sec. 2.2.3 and 3.1.1: Stieltjes'
/// procedure, then Golub and Welsch). `points` have positive weights and ascend; no more than `count` different ones
/// are returned as they are.
std::vector<WeightedPoint> gauss_of_points(std::span<const WeightedPoint> points, int count);

}  // namespace wearwell
