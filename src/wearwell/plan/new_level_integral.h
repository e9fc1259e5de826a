#pragma once

#include <Eigen/Dense>
#include <vector>

namespace wearwell::plan {

/// The mean of a density over an effect z that is standard normal, from the logarithm of the
/// density at a few z. That logarithm is smooth in z even where the density is narrow, so it is
/// interpolated by a polynomial through Chebyshev's nodes (Berrut and Trefethen, Barycentric
/// Lagrange interpolation, SIAM Review 46, 2004, 501-517), and the trapezoidal rule sums its
/// exponential at many z: densities as narrow as 0.03 in z are resolved.
class NewLevelIntegral {
 public:
  /// `intervals` + 1 nodes; every second one is a node of half as many intervals.
  explicit NewLevelIntegral(int intervals);

  const std::vector<double>& z() const { return z_; }

  /// The logarithms of the means, one for each column; rows are the nodes. A column with a density
  /// of 0 at some nodes is summed at the nodes alone.
  std::vector<double> log_means(const Eigen::MatrixXd& log_density) const;

  /// The same by the nodes alone: rough, but never above the highest density.
  std::vector<double> rough_log_means(const Eigen::MatrixXd& log_density) const;

 private:
  std::vector<double> z_;
  Eigen::VectorXd node_log_weight_, log_weight_;  // of the nodes; of the many z
  Eigen::MatrixXd interpolation_;                 // many z x nodes
};

/// With 12, 24, 48 and 96 intervals.
const std::vector<NewLevelIntegral>& new_level_integrals();

}  // namespace wearwell::plan
