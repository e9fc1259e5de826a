#include "wearwell/infer/mode.h"

#include <algorithm>
#include <cmath>

#include "wearwell/infer/maximize.h"
#include "wearwell/math/minimizer.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// In units of the transform's scale; a maximum farther from a plausible start is not accepted.
constexpr double far = 12;

// Newton's method follows a scale over this many factors of e.
constexpr double farthest = 60;

// A maximum flatter than this in some direction is a ridge.
constexpr double least_curvature = 1e-4;

// The smallest eigenvalue of a symmetric matrix scaled to unit diagonal, because magnitudes of 1e-9
// and 1 can occur together.
double least_eigenvalue(const Eigen::MatrixXd& curvature) {
  const double flattest = curvature.diagonal().minCoeff();
  if (!(flattest > 0)) return flattest;
  const Eigen::VectorXd size = curvature.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = size.asDiagonal() * curvature * size.asDiagonal();
  return flattest * scaled.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
}

// Concave in every direction, resolved by differences of 1e-4, and without further gain from a
// Newton step.
bool is_summit(const LogDensity& density, const Mode& mode) {
  constexpr double steepest = 1e5, promise = 1e-3;
  const Eigen::MatrixXd& curvature = mode.curvature;
  if (!curvature.allFinite() || !(curvature.diagonal().maxCoeff() < steepest)) return false;
  if (!(curvature.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > least_curvature)) {
    return false;
  }
  Eigen::VectorXd slope(mode.position.size());
  density.value_and_gradient(view(mode.position), view(slope));
  return slope.dot(curvature.ldlt().solve(slope)) < promise;
}

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
  const Minimum near = minimize(objective, start);
  Mode mode{start, density.value(view(start)), {}, false};
  if (near.converged && (near.position - start).cwiseAbs().maxCoeff() < far) {
    mode.position = near.position;
    mode.log_density = -near.value;
    mode.curvature = curvature_at(density, mode.position);
    mode.found = is_summit(density, mode);
    if (mode.found) return mode;
  }
  // Newton's method adapts its differences to the local widths and follows ridges.
  const auto n = start.size();
  const Box everywhere{Eigen::VectorXd::Constant(n, -INFINITY),
                       Eigen::VectorXd::Constant(n, INFINITY)};
  const Maximum summit = maximize(density, start, Eigen::VectorXd::Ones(n), everywhere);
  if (summit.converged && summit.curvature.allFinite() &&
      (summit.x - start).cwiseAbs().maxCoeff() < farthest) {
    mode.position = summit.x;
    mode.log_density = summit.value;
    mode.curvature = summit.curvature;
    mode.found = least_eigenvalue(mode.curvature) > least_curvature;
    if (mode.found) return mode;
  }
  mode.position = start;
  mode.log_density = density.value(view(start));
  mode.curvature = curvature_at(density, start);
  return mode;
}

}  // namespace wearwell
