#pragma once

#include <functional>
#include <span>
#include <vector>

namespace wearwell::prognosis {

/// The distribution of a life as weighted points, sorted; infinite if the threshold is never
/// reached. Linear between the midpoints of points.
class WeightedLives {
 public:
  WeightedLives() = default;
  /// In any order; weights need not sum to 1. Points of weight 0 are ignored.
  WeightedLives(std::span<const double> life, std::span<const double> weight);

  /// The probability of a life up to x.
  double cdf(double x) const;
  /// The x with cdf(x) = p, 0 < p < 1; infinite if the cdf never reaches p.
  double quantile(double p) const;
  /// The mean of min(life, x): the expected use until x.
  double mean_up_to(double x) const;
  /// The remaining life of those that live beyond x.
  WeightedLives beyond(double x) const;
  std::span<const double> points() const { return life_; }
  std::span<const double> weights() const { return weight_; }  ///< sum to 1

 private:
  std::vector<double> life_, weight_, cumulated_;
};

/// A distribution by 330 points, closer in the tails. `quantile` of 0 < p < 1 may be infinite.
WeightedLives represented_lives(const std::function<double(double p)>& quantile);

/// The largest relative change of the 5, 10, 50 and 95 % quantiles if their probability changes by
/// this much; 0 without points. Infinite quantiles do not count.
double relative_error(const WeightedLives& lives, double probability_error);

}  // namespace wearwell::prognosis
