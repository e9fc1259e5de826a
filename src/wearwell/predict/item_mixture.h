#pragma once

#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/predict/prediction.h"

namespace wearwell {

/// The predictive distribution of a positive quantity with item-to-item variation, for a new item:
/// its logarithm is normal about ln center(x) with standard deviation log_sd(x), mixed over the
/// posterior of x. Quantiles are roots of the exact mixture, without sampling.
class ItemMixture {
 public:
  ItemMixture(const WeightedDraws& draws, const Function& center, const Function& log_sd);

  /// 0 < p < 1. Infinite or 0 if enough centers are; NaN if one with weight is NaN.
  double quantile(double p) const;
  /// The probability of a value up to `value` > 0.
  double cdf(double value) const;

 private:
  double below(double log_value) const;

  std::vector<double> weight_, log_center_, log_sd_;
  bool defined_ = true;
};

/// `count` points of the standard normal distribution for the draw of this index, one in each of as
/// many strata of equal probability. Where in their strata they lie moves evenly from draw to draw,
/// so that over many draws the points fill the distribution.
void stratified_normals(std::size_t draw, std::size_t count, std::vector<double>& z);

}  // namespace wearwell
