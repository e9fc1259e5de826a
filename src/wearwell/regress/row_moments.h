#pragma once

#include <Eigen/Core>

namespace wearwell {

/// The rows of a regression in an orthonormal basis of its columns and its response, and their
/// fourth-order moments: a search by leave-one-out with many rows needs only these.
///
/// With q_i row i of the basis, a residual is e_i = r'q_i and the leverage of a set of columns
/// h_i = q_i' H q_i, where r and H are small; the sum of e_i^2 (1 + 2 h_i) is r' W r with
/// W = I + 2 sum_i (q_i' H q_i) q_i q_i', a combination of the moments. As 1/(1 - h)^2 >= 1 + 2 h,
/// it bounds PRESS from below.
struct RowMoments {
  Eigen::MatrixXd basis;   ///< rows x dimension, orthonormal columns
  Eigen::MatrixXd fourth;  ///< by pairs of coordinates, both ways: sum of q_a q_b q_c q_d

  bool empty() const { return basis.size() == 0; }
  Eigen::Index dimension() const { return basis.cols(); }

  explicit RowMoments(Eigen::MatrixXd orthonormal = {});

  /// W += 2 sum_i (q_i' c)^2 q_i q_i', for a column c of unit length that joins (in coordinates).
  void add_leverage(const Eigen::VectorXd& column, Eigen::MatrixXd& weight) const;
};

}  // namespace wearwell
