#include "wearwell/regress/submodel.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "wearwell/regress/least_squares.h"
#include "wearwell/regress/row_kernels.h"

namespace wearwell {

using namespace row_kernels;

void Submodel::start(const SearchProblem& problem, TermSet candidates) {
  leave_one_out_ = problem.by_rows();
  rows_ = problem.stored;
  model_ = 0;
  model_size_ = 0;
  residuals_.assign(problem.response.begin(), problem.response.end());
  complements_.assign(rows_, 1.0);
  least_complement_ = 1;
  rss_ = dot(residuals(), residuals(), rows_);
  const auto terms = terms_of(candidates);
  storage_.resize(terms.size() * rows_);
  candidates_.clear();
  for (const int term : terms) {
    double* const values = storage_.data() + candidates_.size() * rows_;
    std::copy_n(problem.columns.col(term).data(), rows_, values);
    const double length2 = dot(values, values, rows_);
    const double along = dot(values, residuals(), rows_);
    if (length2 > 0) candidates_.push_back({term, values, length2, along});
  }
}

void Submodel::join(const Submodel& from, int position, int first) {
  const Candidate joining = from.candidates_[position];
  const double inverse = 1 / joining.length2;
  leave_one_out_ = from.leave_one_out_;
  rows_ = from.rows_;
  model_ = from.model_ | bit(joining.term);
  model_size_ = from.model_size_ + 1;
  // Its slot in the storage may be reused by another below, if `from` is this.
  joining_.assign(joining.values, joining.values + rows_);
  const double* const q = joining_.data();

  residuals_.resize(rows_);
  complements_.resize(rows_);
  rss_ = subtract(from.residuals(), joining.along * inverse, q, residuals_.data(), rows_);
  least_complement_ = shrink_complement(from.complements(), q, inverse, complements_.data(), rows_);

  storage_.resize(std::max(storage_.size(), from.candidates_.size() * rows_));
  double* place = storage_.data();
  next_.clear();
  for (int t = first; t < from.count(); ++t) {
    if (t == position) continue;
    const Candidate& other = from.candidates_[t];
    const double share = dot(q, other.values, rows_) * inverse;
    const double length2 = subtract(other.values, share, q, place, rows_);
    if (!(length2 > rank_tolerance * rank_tolerance)) continue;
    next_.push_back({other.term, place, length2, other.along - share * joining.along});
    place += rows_;
  }
  std::swap(candidates_, next_);
}

TermSet Submodel::candidates() const {
  TermSet set = 0;
  for (const auto& candidate : candidates_) set |= bit(candidate.term);
  return set;
}

double Submodel::rss_with(int position) const {
  const Candidate& joining = candidates_[position];
  return rss_ - joining.along * joining.along / joining.length2;
}

double Submodel::press() const {
  return estimable() ? row_kernels::press(residuals(), complements(), rows_)
                     : std::numeric_limits<double>::infinity();
}

double Submodel::press_with(int position) const {
  const Candidate& joining = candidates_[position];
  const double inverse = 1 / joining.length2;
  const auto result = row_kernels::press_with(residuals(), complements(), joining.values,
                                              joining.along * inverse, inverse, rows_);
  return result.least_complement > leverage_tolerance ? result.press
                                                      : std::numeric_limits<double>::infinity();
}

}  // namespace wearwell
