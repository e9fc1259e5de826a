#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace wearwell::plan {

/// Of so many simulated campaigns of a size, how many ended with an interval that is narrow enough.
struct AssurancePoint {
  std::size_t size = 0;  ///< specimens
  std::size_t narrow = 0, runs = 0;

  double share() const { return static_cast<double>(narrow) / static_cast<double>(runs); }
  double error() const;  ///< its Monte Carlo standard error: binomial
};

/// The smallest size with an assurance.
struct SmallestSize {
  std::size_t size = 0;
  /// The sizes at which the assurance would be reached one standard error of the share earlier and
  /// later; both `size` where the assurance jumps there.
  double low = 0, high = 0;
  bool smoothed = false;  ///< from a probit line in ln n through all points; else from the points
};

/// Sizes that were tried, ascending, and the answer.
struct AssuranceSearch {
  std::vector<AssurancePoint> points;
  bool reached = false;  ///< false: not even at the largest size
  SmallestSize smallest = {};
};

/// The smallest size whose assurance reaches the target: doubled from `first` until it does, then
/// bisected in ln n down to neighbours, or until the shares differ by less than their Monte Carlo
/// error; `at` is called once for each size. With the same random
/// numbers for all sizes the shares hardly decrease with the size. Where at least two shares lie
/// between 2 and 98 %, a probit line, share = Phi(a + b ln n), is fitted by maximum likelihood to
/// all points and solved for the target, which averages their noise; b > 0. Its error is that of one
/// share, since the points share their random numbers.
AssuranceSearch search_assurance(const std::function<AssurancePoint(std::size_t size)>& at,
                                 std::size_t first, std::size_t most, double target);

}  // namespace wearwell::plan
