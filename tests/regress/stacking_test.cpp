#include "wearwell/regress/stacking.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

Eigen::MatrixXd random_residuals(int rows, int models, std::uint64_t seed, double common) {
  Rng rng(seed, 0);
  Eigen::MatrixXd residuals(rows, models);
  for (double& e : residuals.reshaped()) e = rng.normal();
  for (int i = 0; i < rows; ++i) residuals.row(i).array() += common * rng.normal();
  return residuals;
}

// Two models: the least of |v a + (1 - v) b|^2 in v, by hand.
TEST(Stacking, TwoModelsByHand) {
  const Eigen::MatrixXd e = random_residuals(30, 2, 1, 0.5);
  const Eigen::VectorXd difference = e.col(1) - e.col(0);
  const double v = e.col(1).dot(difference) / difference.squaredNorm();
  ASSERT_GT(v, 0);
  ASSERT_LT(v, 1);
  const auto weights = stacking_weights(e);
  EXPECT_NEAR(weights[0], v, 1e-12);
  EXPECT_NEAR(weights[1], 1 - v, 1e-12);
}

TEST(Stacking, TheWorseOfTwoParallelModelsGetsNothing) {
  Eigen::MatrixXd e = random_residuals(30, 2, 2, 0);
  e.col(1) = 1.5 * e.col(0);
  const auto weights = stacking_weights(e);
  EXPECT_NEAR(weights[0], 1, 1e-12);
  EXPECT_NEAR(weights[1], 0, 1e-12);
}

// The minimum of a convex function on the simplex: the slope along every vertex is at least that
// along the weights (Karush, Kuhn, Tucker). Holds for many nearly equal models, and with weights.
TEST(Stacking, NoMixtureIsBetter) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const int models = 2 + static_cast<int>(seed % 37);
    const Eigen::MatrixXd e = random_residuals(25, models, seed, seed % 2 == 0 ? 30 : 0.3);
    Eigen::VectorXd rows = Eigen::VectorXd::Ones(25);
    Rng rng(seed, 1);
    if (seed % 3 == 0) {
      for (double& w : rows) w = rng.uniform(0.1, 5);
    }
    const auto weights = stacking_weights(e, rows);
    EXPECT_NEAR(weights.sum(), 1, 1e-12);
    EXPECT_GE(weights.minCoeff(), 0);
    const Eigen::VectorXd mixed = e * weights;
    const double error = (rows.array() * mixed.array().square()).sum();
    for (int m = 0; m < models; ++m) {
      const double slope = (rows.array() * mixed.array() * e.col(m).array()).sum();
      EXPECT_GE(slope, error * (1 - 1e-8)) << "seed " << seed << ", model " << m;
    }
  }
}

TEST(Stacking, AnExactModelTakesAll) {
  Eigen::MatrixXd e = random_residuals(10, 3, 3, 0);
  e.col(1).setZero();
  EXPECT_EQ(stacking_weights(e), Eigen::VectorXd::Unit(3, 1));
  EXPECT_THROW(stacking_weights(Eigen::MatrixXd(5, 0)), InputError);
  e(2, 2) = INFINITY;
  EXPECT_THROW(stacking_weights(e), InputError);
}

}  // namespace
}  // namespace wearwell
