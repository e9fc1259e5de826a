#pragma once

#include <Eigen/Dense>

#include "wearwell/bayes/log_density.h"

namespace wearwell {

/// The mode of a density near `start`, and its curvature.
struct Mode {
  Eigen::VectorXd position;
  double log_density = 0;
  Eigen::MatrixXd curvature;  ///< minus the Hessian of the log density
  bool found = false;  ///< false: the search diverged (no mode, as in a funnel or an improper
                       ///< posterior); then start
};

Mode find_mode(const LogDensity& density, const Eigen::VectorXd& start);

/// Minus the Hessian of the log density at x, by central differences of the gradient.
Eigen::MatrixXd curvature_at(const LogDensity& density, const Eigen::VectorXd& x);

}  // namespace wearwell
