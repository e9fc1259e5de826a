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
  /// `most_after`: the last period after a sale that is asked about. `by_mode`: each of several risks, too.
  ReturnsForecast(const FieldReturns& returns, std::span<const Risk> risks,
                  const WeightedDraws& draws, int most_after, bool by_mode = false);

  ReturnsCount count(std::span<const UnitsAtRisk> groups) const;
  /// Those whose life ends through this risk (its cumulative incidence); only with `by_mode`.
  ReturnsCount count(std::span<const UnitsAtRisk> groups, std::size_t risk) const;
  std::size_t modes() const { return modes_; }  ///< 0 without `by_mode`

 private:
  void add_incidence(std::span<const Risk> risks, const FieldReturns& returns,
                     const Points& points);
  // `fails(point, group)`: the probability of a unit.
  template <class Fails>
  ReturnsCount count_of(std::span<const UnitsAtRisk> groups, const Fails& fails) const;

  std::vector<double> weight_;
  std::size_t ages_ = 0;
  std::vector<double> log_survival_;  // point after point, by period after the sale from -1
  std::size_t modes_ = 0;
  std::vector<double> incidence_;  // likewise, point after point and mode after mode
};

}  // namespace wearwell::formula_model
