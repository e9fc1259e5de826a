#include "wearwell/math/minimizer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

TEST(Minimize, Quadratic) {
  // Condition number 1e6; minimum 3 at (1, -2, 0.5).
  const Eigen::Vector3d center(1, -2, 0.5), curvature(1e-3, 1, 1e3);
  const Objective f = [&](std::span<const double> x, std::span<double> gradient) {
    double sum = 3;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      sum += 0.5 * curvature[i] * std::pow(x[at] - center[i], 2);
      if (!gradient.empty()) gradient[at] = curvature[i] * (x[at] - center[i]);
    }
    return sum;
  };
  const Minimum found = minimize(f, Eigen::Vector3d(100, 100, 100));
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.value, 3, 1e-11);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found.position[i], center[i], 1e-3);
}

// Rosenbrock (1960): from (-1.2, 1) to 0 at (1, 1), along a bent valley.
double rosenbrock(std::span<const double> x, std::span<double> gradient) {
  const double bend = x[1] - x[0] * x[0];
  if (!gradient.empty()) {
    gradient[0] = -400 * x[0] * bend - 2 * (1 - x[0]);
    gradient[1] = 200 * bend;
  }
  return 100 * bend * bend + std::pow(1 - x[0], 2);
}

TEST(Minimize, Rosenbrock) {
  const Minimum found = minimize(rosenbrock, Eigen::Vector2d(-1.2, 1));
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.position[0], 1, 1e-6);
  EXPECT_NEAR(found.position[1], 1, 1e-6);
}

TEST(Minimize, BestPointWhenEvaluationsRunOut) {
  const Minimum found = minimize(rosenbrock, Eigen::Vector2d(-1.2, 1), 5);
  EXPECT_FALSE(found.converged);
  EXPECT_LE(found.value, 24.2);  // at the start
  EXPECT_EQ(found.value, rosenbrock(std::span(found.position.data(), 2), {}));
}

// x - log x has its minimum at 1; from 30, long steps leave the domain x > 0.
double bounded(std::span<const double> x, std::span<double> gradient) {
  if (!(x[0] > 0)) return INFINITY;
  if (!gradient.empty()) gradient[0] = 1 - 1 / x[0];
  return x[0] - std::log(x[0]);
}

TEST(Minimize, ComesBackFromOutsideTheDomain) {
  for (const double start : {30., 1e-3, 0.999}) {
    const Minimum found = minimize(bounded, Eigen::VectorXd::Constant(1, start));
    EXPECT_NEAR(found.position[0], 1, 1e-5) << start;
  }
}

TEST(Minimize, NowhereFinite) {
  const Minimum found = minimize([](auto, auto) { return INFINITY; }, Eigen::Vector2d(3, 4));
  EXPECT_FALSE(found.converged);
  EXPECT_EQ(found.value, INFINITY);
  EXPECT_EQ(found.position, Eigen::Vector2d(3, 4));
}

TEST(Minimize, ErrorOfTheObjectiveReachesTheCaller) {
  const auto broken = [](auto, auto) -> double { throw InputError("column 'v' is missing"); };
  EXPECT_THROW(minimize(broken, Eigen::Vector2d(1, 1)), InputError);
}

}  // namespace
}  // namespace wearwell
