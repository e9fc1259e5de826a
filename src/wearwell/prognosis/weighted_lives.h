#pragma once

#include <span>
#include <vector>

namespace wearwell::prognosis {

/// The distribution of a life as weighted points, sorted; infinite where the limit is never reached. Between
/// the middles of points the distribution is a straight line.
class WeightedLives {
 public:
  WeightedLives() = default;
  /// In any order; weights need not sum to 1. Weight 0 does not count.
  WeightedLives(std::span<const double> life, std::span<const double> weight);

  /// The probability of a life up to x.
  double cdf(double x) const;
  /// The x with cdf(x) = p, 0 < p < 1; infinity where so much is never reached.
  double quantile(double p) const;
  /// The mean of min(life, x): what is lived until x.
  double mean_up_to(double x) const;
  /// Of those that live beyond x, what remains.
  WeightedLives beyond(double x) const;
  std::span<const double> points() const { return life_; }
  std::span<const double> weights() const { return weight_; }  ///< sum to 1

 private:
  std::vector<double> life_, weight_, cumulated_;
};

/// By how much the 5, 10, 50 and 95 % quantiles move, relative to each, the largest, where its probability is off by so much; 0 of no
/// points. Quantiles that are infinite do not count.
double relative_error(const WeightedLives& lives, double probability_error);

}  // namespace wearwell::prognosis
