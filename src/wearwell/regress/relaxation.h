#pragma once

#include <span>
#include <vector>

namespace wearwell {

/// Least squares of a response on a set of columns, in a form from which any column can be removed:
/// the relaxation whose residual sum of squares bounds every model of a branch.
///
/// It keeps coordinates X with A X orthonormal (A: the columns) and z = (A X)' response. Then the
/// coefficients are X z, and removing column t raises the residual sum of squares by (x_t z)^2 /
/// |x_t|^2, where x_t is row t of X. A Householder reflection that turns x_t into a multiple of the
/// last axis leaves X for the other columns after the last coordinate is dropped.
class Relaxation {
 public:
  /// Orthogonalizes `columns` (each `rows` long, padded as in row_kernels.h) by modified
  /// Gram-Schmidt, in that order. Columns that depend on earlier ones are skipped. Overwrites
  /// `columns` and `response`; `response` then has the residuals.
  void factor(std::span<double* const> columns, double* response, int rows);

  /// Whether a column, as numbered in the last factor(), depends on earlier ones.
  bool depends(int column) const { return coordinate_[column] < 0; }

  /// The first `count` columns can no longer be removed; the others are renumbered from 0.
  void fix(int count);

  /// Removes column t. The columns after it move up by one. Not while `dependent()`.
  void drop(int t);

  /// Sets this to `from` without column `order[0]`, with columns `order[1], order[2], ...`; columns
  /// not in `order` can no longer be removed. Not while `dependent()`.
  void drop_first(const Relaxation& from, std::span<const int> order);

  int size() const { return size_; }
  double rss() const { return rss_; }
  /// True if some columns depend on others; removing columns then needs a new factor().
  bool dependent() const { return dependent_; }

  /// Fills the coefficients and the increase of the residual sum of squares by removing each column
  /// (a lower bound of it if columns are dependent).
  void analyse();
  double coefficient(int t) const { return coefficient_[t]; }
  double cost(int t) const { return cost_[t]; }

 private:
  double* row(int t) { return x_.data() + t * stride_; }
  const double* row(int t) const { return x_.data() + t * stride_; }
  void invert(int count);
  void find_replaceable(int count);
  /// Sets mirror_ to take the row `removed` to its last axis; returns the factor for reflect().
  double aim(const double* removed, int rank);
  void reflect(const double* from, double factor, double* to) const;

  int size_ = 0;    ///< rows of X: removable columns
  int rank_ = 0;    ///< columns of X
  int stride_ = 0;  ///< of a row of X; zeros after `rank_`
  double rss_ = 0;
  bool dependent_ = false;
  std::vector<double> x_, z_;
  std::vector<char> costless_;  ///< by row: other columns can replace it because of dependence
  std::vector<double> coefficient_, cost_;
  std::vector<double> mirror_;

  // Of the last factorization, by column in the given order.
  std::vector<double> upper_;                ///< unit upper triangle, rows of stride_
  std::vector<double> length2_, original2_;  ///< squared lengths, orthogonalized and original
  std::vector<int> coordinate_;              ///< column of X; -1 if dependent
};

}  // namespace wearwell
