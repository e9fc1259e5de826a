#pragma once

#include <Eigen/Dense>
#include <functional>
#include <span>

namespace wearwell {

/// Value at `x` and, when `gradient` is not empty, the gradient there. Infinity marks a point
/// outside the domain; the gradient is not needed there.
using Objective = std::function<double(std::span<const double> x, std::span<double> gradient)>;

struct Minimum {
  Eigen::VectorXd position;
  double value = 0;
  bool converged = false;  ///< false: stopped by the evaluation limit or without progress
};

/// A local minimum near `start`, by NLopt's L-BFGS; the best point seen, even without convergence.
/// Exceptions of the objective reach the caller.
Minimum minimize(const Objective& objective, const Eigen::VectorXd& start,
                 int max_evaluations = 1000);

}  // namespace wearwell
