#include "wearwell/models/formula_model/normal_unit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace wearwell::formula_model {
namespace {

// Readings y = Z s + noise of a unit, s = A z: y is normal with covariance Z A A' Z' + I. However many
// the rows, so that H may have any rank, and however far apart the sizes are.
TEST(NormalUnit, IsAJointNormalLawOfAnyRank) {
  for (const int rows : {1, 2, 5}) {
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

        // In long double: the dense way loses digits where readings are worth much.
        using Dense = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
        const Dense ZA = (Z * A).cast<long double>(), one = Dense::Identity(rows, rows);
        const Dense column = y.cast<long double>();
        const Eigen::LDLT<Dense> solver(ZA * ZA.transpose() + one);
        const double log_det = solver.vectorD().array().log().sum();
        const double quadratic = column.cwiseProduct(solver.solve(column)).sum();
        const double expected = -0.5 * (log_det + quadratic);
        const NormalUnit unit(best, H, A);
        const double scale = 1 + std::abs(expected);
        EXPECT_NEAR(top + unit.log_integral, expected, 1e-9 * scale) << rows << ' ' << size;

        const Eigen::Matrix2d spread =
            (Dense::Identity(2, 2) - ZA.transpose() * solver.solve(ZA)).cast<double>();
        const Eigen::Vector2d mean = (ZA.transpose() * solver.solve(column)).cast<double>();
        EXPECT_LT((unit.mean - mean).norm(), 1e-7 * (1 + mean.norm()));
        EXPECT_LT((unit.square - spread - mean * mean.transpose()).norm(),
                  1e-7 * (1 + mean.squaredNorm()));
      }
    }
  }
}

TEST(NormalUnit, WithoutRowsIsThePopulation) {
  const Eigen::Matrix2d A = Eigen::Vector2d(0.8, 0.3).asDiagonal();
  const NormalUnit unit(Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero(), A);
  EXPECT_EQ(unit.log_integral, 0);
  EXPECT_EQ(unit.mean, Eigen::Vector2d::Zero());
  EXPECT_EQ(unit.square, Eigen::Matrix2d::Identity());
}

}  // namespace
}  // namespace wearwell::formula_model
