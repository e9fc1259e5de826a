#pragma once

#include <vector>

#include "wearwell/regress/least_squares.h"
#include "wearwell/regress/search_problem.h"

namespace wearwell {

/// A model with its residuals and leverages, and other columns made orthogonal to it, so that
/// adding one takes a step proportional to the number of rows. Orthogonalization is modified
/// Gram-Schmidt; adding column t costs one projection of every other column.
class Submodel {
 public:
  /// The empty model with all `candidates`.
  void start(const SearchProblem& problem, TermSet candidates);

  /// Sets this to `from` with its candidate `position` added to the model. Candidates before
  /// `first`, and those that now depend on the model, are removed permanently. Storage is reused;
  /// `from` may be this.
  void join(const Submodel& from, int position, int first = 0);

  /// Removes a candidate.
  void remove(int position) { candidates_.erase(candidates_.begin() + position); }

  TermSet model() const { return model_; }
  int model_size() const { return model_size_; }
  int count() const { return static_cast<int>(candidates_.size()); }
  int term(int position) const { return candidates_[position].term; }
  TermSet candidates() const;
  const double* column(int position) const { return candidates_[position].values; }
  double length2(int position) const { return candidates_[position].length2; }
  const double* residuals() const { return residuals_.data(); }
  /// 1 - leverage of each row; at most leverage_tolerance in a row that alone determines a
  /// coefficient.
  const double* complements() const { return complements_.data(); }
  int rows() const { return rows_; }

  double rss() const { return rss_; }
  double rss_with(int position) const;  ///< after a candidate is added
  double press() const;                 ///< infinite if the model is not estimable
  double press_with(int position) const;
  /// PRESS (loo) or the residual sum of squares, by the problem's criterion.
  double error() const { return leave_one_out_ ? press() : rss(); }
  double error_with(int position) const {
    return leave_one_out_ ? press_with(position) : rss_with(position);
  }
  /// False if one row alone determines a coefficient: then no larger model has leave-one-out
  /// residuals.
  bool estimable() const { return !leave_one_out_ || least_complement_ > leverage_tolerance; }

 private:
  struct Candidate {
    int term;
    double* values;
    double length2;
    double along;  ///< residuals of `values`
  };

  bool leave_one_out_ = true;
  int rows_ = 0;
  TermSet model_ = 0;
  int model_size_ = 0;
  double least_complement_ = 1;
  double rss_ = 0;
  std::vector<double> storage_, residuals_, complements_, joining_;
  std::vector<Candidate> candidates_, next_;
};

}  // namespace wearwell
