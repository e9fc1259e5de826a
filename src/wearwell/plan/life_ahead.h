#pragma once

#include <span>
#include <vector>

#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::plan {

/// When one unit reaches its threshold, from now on (SI), averaged over all that is uncertain of
/// it: with probability `passed` it has already done so.
class LifeAhead {
 public:
  /// `lives`: given that it has not; not empty unless `passed` is 1.
  LifeAhead(double passed, prognosis::WeightedLives lives);

  double passed() const { return passed_; }
  /// The probability that the threshold is reached by then; `passed` at 0.
  double reached(double time) const;
  /// The expected use until then without that beyond the threshold: the integral of 1 - reached.
  double used(double time) const;
  /// The latest time by which the threshold is reached with at most this probability, p >= passed.
  /// Infinite if that holds for ever.
  double latest(double p) const;
  /// The number of points of the distribution that lie in an interval (from, to].
  std::size_t points(double from, double to) const;

 private:
  double passed_ = 0;
  prognosis::WeightedLives lives_;
  std::vector<double> used_;  // the integral of the survival function up to each finite point
};

}  // namespace wearwell::plan
