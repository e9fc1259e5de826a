#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/loo.h"
#include "wearwell/math/log_sum_exp.h"

namespace wearwell {

/// Sums over weighted posterior points for the leave-one-out prediction of one term: w/p, with the
/// term's density p at a point of weight w, relative to the largest so far; and the sum of w p.
class LeftOut {
 public:
  void add(double log_weight, double log_p, const NormalScore* score) {
    const double log_inverse = log_weight - log_p;
    if (!std::isfinite(log_inverse)) return;
    rescale(std::max(top_, log_inverse));
    const double weight = std::exp(log_inverse - top_);
    sum_ += weight;
    with_.add(log_weight + log_p);
    if (!score) return;
    if (score->exact()) {
      const double beyond = normal_cdf(-std::abs(score->high));
      below_ += weight * (score->high < 0 ? beyond : 1 - beyond);
      above_ += weight * (score->high < 0 ? 1 - beyond : beyond);
      return;
    }
    below_ += weight * normal_cdf(score->high);
    above_ += weight * normal_cdf(-score->low);
  }

  void add(const LeftOut& other) {
    if (other.sum_ == 0) return;
    rescale(std::max(top_, other.top_));
    const double factor = std::exp(other.top_ - top_);
    sum_ += factor * other.sum_;
    with_.add(other.with_);
    below_ += factor * other.below_;
    above_ += factor * other.above_;
  }

  double log_sum() const { return top_ + std::log(sum_); }  ///< log of the sum of w/p
  double elpd() const { return -log_sum(); }
  double lpd() const { return with_.value(); }  ///< log of the sum of w p
  double tail() const { return std::min(1.0, 2 * std::min(below_, above_) / sum_); }

 private:
  void rescale(double top) {
    if (top == top_) return;
    const double factor = std::exp(top_ - top);
    for (double* each : {&sum_, &below_, &above_}) *each *= factor;
    top_ = top;
  }

  double top_ = -std::numeric_limits<double>::infinity();
  double sum_ = 0, below_ = 0, above_ = 0;
  RunningLogSum with_;  // its scale is another: w p and w/p differ by p squared
};

/// The sums of each term over all points, in parts of fixed size, so that they do not depend on
/// threads.
std::vector<LeftOut> left_out(const LogDensity& likelihood, const WeightedDraws& points,
                              std::size_t terms, const Scores* scores, Eigen::Index part = 512);

/// The score of one term at a draw; empty without tails.
using ScoreAt = std::function<NormalScore(std::size_t draw)>;

/// One term from equally weighted draws with smoothed importance weights: elpd, lpd, k-hat, tail.
/// `log_p` are its log densities at the draws; they are replaced by the first-order influence of
/// each draw on the error of elpd, over all observations of the term.
void leave_out_smoothed(LooTerm& term, Eigen::Ref<Eigen::VectorXd> log_p, const ScoreAt& score);

/// The first-order influence of a draw with this weight on the error of elpd.
double influence(const LooTerm& term, double log_weight, double log_p);

}  // namespace wearwell
