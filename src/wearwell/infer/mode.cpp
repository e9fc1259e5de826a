#include "wearwell/infer/mode.h"

#include <algorithm>
#include <cmath>

#include "wearwell/infer/climb.h"
#include "wearwell/math/minimizer.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// In units of the transform's own scale: a mode farther from a plausible start is no mode.
constexpr double far = 12;

// A summit flatter than this in some direction is a ridge.
constexpr double least_curvature = 1e-4;

}  // namespace

Eigen::MatrixXd curvature_at(const LogDensity& density, const Eigen::VectorXd& x) {
  constexpr double step = 1e-4;
  const Eigen::Index n = x.size();
  Eigen::MatrixXd curvature(n, n);
  Eigen::VectorXd above(n), below(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::VectorXd moved = x;
    moved[i] = x[i] + step;
    density.value_and_gradient(view(moved), view(above));
    moved[i] = x[i] - step;
    density.value_and_gradient(view(moved), view(below));
    curvature.col(i) = (below - above) / (2 * step);
  }
  return 0.5 * (curvature + curvature.transpose());
}

Mode find_mode(const LogDensity& density, const Eigen::VectorXd& start) {
  const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
    if (gradient.empty()) return -density.value(x);
    const double value = density.value_and_gradient(x, gradient);
    for (double& slope : gradient) slope = std::isfinite(value) ? -slope : 0;
    return -value;
  };
  Minimum best = minimize(objective, start);
  if (!best.converged) {
    const auto n = start.size();
    const Summit summit =
        climb(density, start, Eigen::VectorXd::Ones(n),
              {Eigen::VectorXd::Constant(n, -INFINITY), Eigen::VectorXd::Constant(n, INFINITY)});
    best = {summit.x, -summit.value, summit.converged};
  }
  Mode mode{start, density.value(view(start)), {}, false};
  if ((best.position - start).cwiseAbs().maxCoeff() < far) {
    mode.position = best.position;
    mode.log_density = -best.value;
    mode.found = best.converged;
  }
  mode.curvature = curvature_at(density, mode.position);
  mode.found =
      mode.found && mode.curvature.allFinite() &&
      mode.curvature.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > least_curvature;
  if (!mode.found) mode.position = start;
  return mode;
}

}  // namespace wearwell
