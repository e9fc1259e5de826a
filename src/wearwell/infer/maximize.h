#pragma once

#include <Eigen/Dense>

#include "wearwell/bayes/log_density.h"

namespace wearwell {

/// Between which values a climb stays; infinite where it may go anywhere.
struct Box {
  Eigen::VectorXd lower, upper;
};

/// Where a climb ended.
struct Maximum {
  Eigen::VectorXd x;
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd curvature;  ///< minus the Hessian
  bool converged = false;     ///< no way up is left, and the density falls in every free direction
};

/// Uphill from `start` to a local maximum in the box by Newton's method: the curvature by
/// differences of the gradient and made positive, steps halved until they go up, parameters on a
/// bound held there as long as the density rises beyond it (Bertsekas 1982). For few parameters,
/// strongly correlated ones and starts far from any maximum, where L-BFGS gives up in its first
/// line search. `unit` > 0 is about how far a parameter may move; the climb ends where another step
/// promises less than `enough` of the log density.
Maximum maximize(const LogDensity& density, const Eigen::VectorXd& start,
                 const Eigen::VectorXd& unit, const Box& box, double enough = 1e-14);

}  // namespace wearwell
