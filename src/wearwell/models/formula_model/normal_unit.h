#pragma once

#include <Eigen/Core>

namespace wearwell::formula_model {

/// A unit whose log-likelihood is quadratic in the steps s of its effects,
///
///   log p(data | s) = top - (s - best)' H (s - best)/2,
///
/// where effects are normal, s = A z with z standard normal: the integral over z, and the posterior of
/// z, have closed forms. With one effect the second entries are 0.
struct NormalUnit {
  double log_integral;     ///< without the top
  Eigen::Vector2d mean;    ///< of z under the unit's posterior
  Eigen::Matrix2d square;  ///< mean of z z'

  NormalUnit(const Eigen::Vector2d& best, const Eigen::Matrix2d& H, const Eigen::Matrix2d& A);
};

}  // namespace wearwell::formula_model
