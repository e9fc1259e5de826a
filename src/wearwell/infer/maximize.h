#pragma once

#include <Eigen/Dense>

#include "wearwell/bayes/log_density.h"

namespace wearwell {

/// The bounds of a search; may be infinite.
struct Box {
  Eigen::VectorXd lower, upper;
};

/// The end of a search.
struct Maximum {
  Eigen::VectorXd x;
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd curvature;  ///< minus the Hessian
  bool converged = false;     ///< no ascent is possible, and the density is concave in every free
                              ///< direction
};

/// Finds a local maximum in the box from `start` by Newton's method: curvature from differences of
/// the gradient, made positive definite; backtracking; parameters at a bound are fixed while the
/// density increases beyond it (Bertsekas 1982). For few, strongly correlated parameters and starts
/// far from a maximum, where L-BFGS fails in its first line search. `unit` > 0 is about the
/// possible change of a parameter; the search ends when the predicted gain of the log density is
/// less than `enough`.
Maximum maximize(const LogDensity& density, const Eigen::VectorXd& start,
                 const Eigen::VectorXd& unit, const Box& box, double enough = 1e-14);

}  // namespace wearwell
