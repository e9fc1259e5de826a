#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell {

/// The ranking of submodels. `loo`: the leave-one-out sum of squares PRESS (so R2p); the others
/// weigh the residual sum of squares against the number of terms. Formulas: least_squares.h.
enum class Criterion { loo, aic, aicc, bic, cp, adjr2 };

/// "loo", "aic", "aicc", "bic", "cp", "adjr2". Throws InputError for another name.
Criterion read_criterion(std::string_view name);
std::string_view name_of(Criterion criterion);

/// A criterion as a positive score to minimize, with the same form for every criterion: score =
/// factor[k] * error + offset[k] for a model of k terms, where error is PRESS (loo) or the residual
/// sum of squares (the others). Both grow with k. E.g. bic: factor[k] = n^(k/n), since n log(rss) +
/// k log(n) = n log(rss n^(k/n)).
class Score {
 public:
  /// rows: n; terms: the largest k; tss: total sum of squares; s2: residual variance of all
  /// terms (cp only); log_weights: sum of log w_i.
  Score(Criterion criterion, int rows, int terms, double tss, double s2, double log_weights);

  Criterion criterion() const { return criterion_; }
  /// False for sizes with too few rows for the criterion; their score is infinite.
  bool admits(int size) const { return factor_[size] < std::numeric_limits<double>::infinity(); }
  double of(double error, int size) const { return factor_[size] * error + offset_[size]; }
  /// The error at which a model of `size` has `score`; -infinity for inadmissible sizes.
  double error_at(double score, int size) const;
  /// The criterion in its own unit: PRESS, AIC, ..., adjusted R2 (to maximize).
  double value(double score) const;
  /// The score that is worse than `best` by `distance`: for loo a fraction of PRESS, for the others
  /// an absolute difference of the criterion.
  double worse_by(double best, double distance) const;

 private:
  Criterion criterion_;
  double rows_, tss_, s2_, log_weights_;
  std::vector<double> factor_, offset_;  ///< by size
};

}  // namespace wearwell
