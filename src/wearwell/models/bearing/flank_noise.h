#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace wearwell::bearing {

/// What noise of flanks says about a sum over points of the same noise.
struct FlankNoise {
  double sd = 0;           ///< of the sum
  double half_width = 0;   ///< of its interval of 90 %
  double correlation = 1;  ///< as many neighbouring points count as one
};

/// Noise whose autocorrelation at lag j is a phi^j (a first-order memory beside white noise), of
/// unknown size, a and phi. `residuals` are those of the flanks, points [0, left) and [right, n) of
/// a sequence, from a line of `design` (a row for each of the n points; those between are not
/// looked at). The sum is that of `weights` times noise over all n points.
///
/// Each phi and a of a grid has the weight of its restricted likelihood (which does not take
/// residuals for noise: what the line has taken out is counted), size integrated out; given them the
/// sum is Student's. Its mixture is wider than any one estimate would make it: from some dozen
/// independent points, memory is not known well.
FlankNoise flank_noise(const std::vector<double>& residuals, const Eigen::MatrixXd& design,
                       std::size_t left, std::size_t right, const std::vector<double>& weights);

}  // namespace wearwell::bearing
