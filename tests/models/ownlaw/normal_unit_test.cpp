#include "wearwell/models/ownlaw/normal_unit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace wearwell::ownlaw {
namespace {

// Readings y = Z s + noise of a unit, s = A z: y is normal with covariance Z A A' Z' + I. However many
// the rows, so that H may have any rank, and however far apart the sizes are.
TEST(NormalUnit, IsAJointNormalLawOfAnyRank) {
  for (const int rows : {0, 1, 2, 5}) {
    for (const double size : {1e-5, 0.3, 1.0, 1e4}) {
      for (const double r : {-0.999, 0.0, 0.6}) {
        Eigen::MatrixXd Z(rows, 2);
        Eigen::VectorXd y(rows);
        for (int i = 0; i < rows; ++i) {
          Z.row(i) << size, size * (0.7 + 0.4 * i * i);
          y[i] = size * (1.3 + 0.2 * i) + 0.5 * std::sin(3.0 * i);
        }
        Eigen::Matrix2d A;
        A << 0.8, 0, 0.3 * r, 0.3 * std::sqrt(1 - r * r);
        const Eigen::Matrix2d H = Z.transpose() * Z;
        const Eigen::Vector2d best =
            H.completeOrthogonalDecomposition().solve(Eigen::Vector2d(Z.transpose() * y));
        const double top = -0.5 * (y - Z * best).squaredNorm();

        const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(rows, rows);
        const Eigen::MatrixXd ZA = Z * A, covariance = ZA * ZA.transpose() + one;
        const Eigen::LDLT<Eigen::MatrixXd> solver(covariance);
        const double log_det = rows > 0 ? solver.vectorD().array().log().sum() : 0;
        const double expected = rows > 0 ? -0.5 * (log_det + y.dot(solver.solve(y))) : 0;
        const NormalUnit unit(best, H, A);
        const double scale = 1 + std::abs(expected) + size * size * 1e-3;
        EXPECT_NEAR(top + unit.log_integral, expected, 1e-9 * scale) << rows << ' ' << size;

        if (rows == 0 || size > 100) continue;  // the dense way loses its digits first
        const Eigen::Matrix2d spread =
            Eigen::Matrix2d::Identity() - ZA.transpose() * solver.solve(ZA);
        const Eigen::Vector2d mean = ZA.transpose() * solver.solve(y);
        EXPECT_LT((unit.mean - mean).norm(), 1e-7 * (1 + mean.norm()));
        EXPECT_LT((unit.square - spread - mean * mean.transpose()).norm(),
                  1e-7 * (1 + mean.squaredNorm()));
      }
    }
  }
}

}  // namespace
}  // namespace wearwell::ownlaw
