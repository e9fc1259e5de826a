#pragma once

#include <span>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/formula_model/field_returns.h"
#include "wearwell/models/formula_model/formula_life.h"

namespace wearwell::formula_model {

/// A number of returns over a posterior: expected, with its 90 % credible interval; and the 90 %
/// prediction interval of the number, in whole numbers.
struct ReturnsCount {
  double expected = 0, low = 0, high = 0;
  double sd = 0;  ///< of the number
  double count_low = 0, count_high = 0;
};

/// Units of one period of sale that have not come back at the end of period `seen` after it (-1: not
/// yet sold), and the periods after the sale in which their returns are counted, first to last.
struct UnitsAtRisk {
  double units = 0;
  int seen = -1, first = 0, last = 0;
};

/// Returns over a posterior of lives. The survival function is evaluated once, at each point and
/// age; given the parameters units fail independently, so that a sum over periods of sale has the
/// mean and the variance of a sum of binomial numbers (predict/count_quantile.h).
class ReturnsForecast {
 public:
  /// `most_after`: the last period after a sale that is asked about.
  ReturnsForecast(const FieldReturns& returns, std::span<const Risk> risks,
                  const WeightedDraws& draws, int most_after);

  ReturnsCount count(std::span<const UnitsAtRisk> groups) const;

 private:
  std::vector<double> weight_;
  std::size_t ages_ = 0;
  std::vector<double> log_survival_;  // point after point, by period after the sale from -1
};

}  // namespace wearwell::formula_model
