#pragma once

#include <vector>

#include "wearwell/regress/least_squares.h"
#include "wearwell/regress/search_problem.h"

namespace wearwell {

/// A model with its residuals and leverages, and other columns made orthogonal to it, so that one
/// of them joins the model in a step proportional to the rows. Orthogonalization is modified
/// Gram-Schmidt; column t joins at the price of one projection of every other column.
class Submodel {
 public:
  /// The empty model beside all `candidates`.
  void start(const SearchProblem& problem, TermSet candidates);

  /// Sets this to `from` with its candidate `position` in the model. Candidates before `first`, and
  /// those that depend on the model now, are left out for good. Storage is reused; `from` may be
  /// this.
  void join(const Submodel& from, int position, int first = 0);

  /// Forgets a candidate.
  void remove(int position) { candidates_.erase(candidates_.begin() + position); }

  TermSet model() const { return model_; }
  int model_size() const { return model_size_; }
  int count() const { return static_cast<int>(candidates_.size()); }
  int term(int position) const { return candidates_[position].term; }
  TermSet candidates() const;
  const double* column(int position) const { return candidates_[position].values; }
  double length2(int position) const { return candidates_[position].length2; }
  const double* residuals() const { return residuals_.data(); }
  /// 1 - leverage of each row; at most leverage_tolerance in a row that nothing else determines.
  const double* complements() const { return complements_.data(); }
  int rows() const { return rows_; }

  double rss() const { return rss_; }
  double rss_with(int position) const;  ///< after a candidate joins
  double press() const;                 ///< infinite where the model is not estimable
  double press_with(int position) const;
  /// PRESS (loo) or the residual sum of squares, whichever the problem goes by.
  double error() const { return leave_one_out_ ? press() : rss(); }
  double error_with(int position) const {
    return leave_one_out_ ? press_with(position) : rss_with(position);
  }
  /// False when one row alone determines a coefficient: then no larger model can be left one out.
  bool estimable() const { return !leave_one_out_ || least_complement_ > leverage_tolerance; }

 private:
  struct Candidate {
    int term;
    double* values;
    double length2;
    double along;  ///< values' residuals
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
