#include "wearwell/models/formula_model/normal_unit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace wearwell::formula_model {

using Matrix2 = Eigen::Matrix2d;
using Vector2 = Eigen::Vector2d;

NormalUnit::NormalUnit(const Vector2& best, const Matrix2& H, const Matrix2& A) {
  // (H^-1 + S)^-1 = (H + det(H) adj(S)) / det(I + A' H A), S = A A': sums of non-negative terms, so
  // that H may be singular and large H causes no cancellation.
  const Matrix2 S = A * A.transpose(), B = Matrix2::Identity() + A.transpose() * H * A;
  Matrix2 adjugate;
  adjugate << S(1, 1), -S(0, 1), -S(0, 1), S(0, 0);
  const double det_H = std::max(0.0, H.determinant()), det_B = B.determinant();
  log_integral = -0.5 * (best.dot((H + det_H * adjugate) * best) / det_B + std::log(det_B));
  const Matrix2 spread = B.inverse();
  mean = spread * (A.transpose() * (H * best));
  square = spread + mean * mean.transpose();
}

}  // namespace wearwell::formula_model
