#pragma once

#include <span>
#include <vector>

namespace wearwell {

/// Least squares of a response on a set of columns, made so that any column can be taken out again:
/// the relaxation whose residual sum of squares bounds every model of a branch.
///
/// It keeps coordinates X with A X orthonormal (A: the columns) and z = (A X)' response. Then the
/// coefficients are X z, and taking column t out raises the residual sum of squares by
/// (x_t z)^2 / |x_t|^2, where x_t is row t of X. A Householder reflection that turns x_t into a
/// multiple of the last axis leaves X for the other columns when the last coordinate is dropped.
class Relaxation {
 public:
  /// Orthogonalizes `columns` (each `rows` long, padded as in row_kernels.h) by modified
  /// Gram-Schmidt, in that order. Columns that depend on earlier ones take no part.
  /// `columns` and `response` are overwritten; `response` is left as the residuals.
  void factor(std::span<double* const> columns, double* response, int rows);

  /// Whether a column, as numbered in the last factor(), depends on earlier ones.
  bool depends(int column) const { return coordinate_[column] < 0; }

  /// The first `count` columns can no longer be taken out; the others are numbered from 0 anew.
  void fix(int count);

  /// Takes column t out. The columns after it move up by one. Not while `dependent()`.
  void drop(int t);

  /// Sets this to `from` without column `order[0]`, its columns `order[1], order[2], ...`; the
  /// columns that `order` does not name can no longer be taken out. Not while `dependent()`.
  void drop_first(const Relaxation& from, std::span<const int> order);

  int size() const { return size_; }
  double rss() const { return rss_; }
  /// True when some columns depend on others; taking columns out then needs factor() anew.
  bool dependent() const { return dependent_; }

  /// Fills coefficients and what taking each column out would add to the residual sum of squares
  /// (a lower bound of it where columns are dependent).
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

  int size_ = 0;    ///< rows of X: columns that can be taken out
  int rank_ = 0;    ///< columns of X
  int stride_ = 0;  ///< of a row of X; zeros after `rank_`
  double rss_ = 0;
  bool dependent_ = false;
  std::vector<double> x_, z_;
  std::vector<char> costless_;  ///< by row: dependence lets the other columns do its work
  std::vector<double> coefficient_, cost_;
  std::vector<double> mirror_;

  // Of the last factorization, by column in the order given.
  std::vector<double> upper_;                ///< unit upper triangle, rows of stride_
  std::vector<double> length2_, original2_;  ///< squared lengths, orthogonalized and as given
  std::vector<int> coordinate_;              ///< column of X; -1 if dependent
};

}  // namespace wearwell
