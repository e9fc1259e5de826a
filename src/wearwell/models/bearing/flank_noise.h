#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace wearwell::bearing {

/// The distribution of a sum over points of the same noise, inferred from the flanks.
struct FlankNoise {
  double sd = 0;           ///< of the sum
  double half_width = 0;   ///< of its 90 % interval
  double correlation = 1;  ///< number of neighbouring points that count as one
};

/// Noise whose autocorrelation at lag j is a phi^j (a first-order memory beside white noise), of
/// unknown size, a and phi. `residuals` are those of the flanks, points [0, left) and [right, n) of
/// a sequence, from a line of `design` (a row for each of the n points; those between are not
/// used). The sum is that of `weights` times noise over all n points.
///
/// Each phi and a of a grid is weighted by its restricted likelihood (which accounts for the fitted
/// line), with the size integrated out; given them the sum has a Student t distribution. The
/// mixture is wider than with any single estimate: a few dozen independent points do not determine
/// the memory well.
FlankNoise flank_noise(const std::vector<double>& residuals, const Eigen::MatrixXd& design,
                       std::size_t left, std::size_t right, const std::vector<double>& weights);

}  // namespace wearwell::bearing
