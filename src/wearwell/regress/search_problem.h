#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/regress/criterion.h"
#include "wearwell/regress/row_moments.h"

namespace wearwell {

/// A set of terms: bit t is term t.
using TermSet = std::uint64_t;
inline constexpr int most_search_terms = 64;

inline TermSet bit(int term) {
  return TermSet{1} << term;
}
inline TermSet every_term(int terms) {
  return terms == most_search_terms ? ~TermSet{0} : bit(terms) - 1;
}
std::vector<int> terms_of(TermSet set);

/// Computed bounds and errors are accurate to this relative error: a branch is cut only if its
/// bound exceeds the limit by more. Rounding stays far below (subset_search.md).
inline constexpr double bound_slack = 1e-6;

/// Throws InputError that begins with `name` if squares and products of the values overflow or
/// underflow.
void require_size(const std::string& name, const Eigen::VectorXd& values);

/// A regression prepared for the search: rows multiplied by the root of their weight, columns of
/// unit length (which changes no fit), rows padded with zeros to a multiple of row_block. For
/// criteria of the residual sum of squares, the rows are those of the R factor of [columns,
/// response]; so they are for leave-one-out with many rows, together with the moments of the rows.
struct SearchProblem {
  SearchProblem(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                const Eigen::VectorXd& weights, Criterion criterion, bool all_rows = false);

  int terms = 0;
  int rows = 0;    ///< of the data
  int stored = 0;  ///< rows of `columns`
  bool leave_one_out = true;
  RowMoments moments;  ///< for leave-one-out with many rows, unless `all_rows` is set
  /// Whether PRESS is computed from `columns`, row by row.
  bool by_rows() const { return leave_one_out && moments.empty(); }
  Eigen::MatrixXd columns;   ///< stored x terms
  Eigen::VectorXd response;  ///< stored
  double tss = 0;            ///< about the weighted mean
  /// Errors below this are rounding: the fit is exact, and all exact fits are ties.
  double least_error = 0;
  Score score;
};

/// PRESS (loo) or the residual sum of squares of one model by Householder QR, the same to the bit
/// for any path of the search. Empty if the terms are linearly dependent or, for loo, if one row
/// alone determines a coefficient.
std::optional<double> exact_error(const SearchProblem& problem, TermSet model);

}  // namespace wearwell
