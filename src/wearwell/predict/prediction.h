#pragma once

#include <functional>
#include <vector>

#include "wearwell/bayes/observation.h"
#include "wearwell/bayes/weighted_draws.h"

namespace wearwell {

/// A number that depends on the parameters: `x` has one entry a parameter, natural, SI; the result is SI.
using Function = std::function<double(const double* x)>;

/// The same for one item of a population with item-to-item variation: z is standard normal over the
/// items.
using ItemFunction = std::function<double(const double* x, double z)>;

/// The points with all but a millionth of the weight, because quadrature nodes reach far into the
/// tails. Weights are rescaled to sum to 1.
struct DominantDraws {
  explicit DominantDraws(const WeightedDraws& draws);
  std::vector<Eigen::Index> rows;
  std::vector<double> weights;
};

/// The probabilities at which intervals end: 0 < lower < upper < 1.
struct Ends {
  double lower = 0.05, upper = 0.95;
};

/// A prediction in SI: the posterior of the true mean, and the predictive distribution of one measurement of it.
struct Prediction {
  double mean = 0;  ///< of the true mean
  double ci05 = 0;  ///< credible interval of the true mean, 5 % to 95 %
  double ci95 = 0;
  double pi05 = 0;  ///< prediction interval of one measurement, 5 % to 95 %
  double pi95 = 0;
};

/// `mean` and `sd` of the measurement as functions of the parameters. The prediction interval has
/// the exact quantiles of the mixture over all draws, without additional noise. With `item` it is
/// the interval of a measurement of a new item with that true value: `points` items over all draws,
/// 200,000 for 4 digits. `ends` replaces the probabilities of the quantiles named 05 and 95.
Prediction predict(const WeightedDraws& draws, const Function& mean, const Function& sd,
                   ObservationFamily family, const ItemFunction& item = {},
                   std::size_t points = 200'000, const Ends& ends = {});

/// Quantiles of a life, in the unit of the life; infinite where it is never reached.
struct Life {
  double b1 = 0;  ///< 1 % quantile
  double b10 = 0;
  double b50 = 0;
  double q05 = 0;  ///< the 90 % interval
  double q95 = 0;
  double inspect_within = 0;  ///< from `now`: the longest wait with at most `risk` of reaching it,
                              ///< given that the limit is not reached
  double passed = 0;          ///< the probability that the limit is reached by `now`
};

/// The distribution of a life, mixed over a posterior: cdf and its inverse.
struct LifeDistribution {
  std::function<double(double life)> cdf;
  std::function<double(double p)> quantile;  ///< 0 < p < 1
};

/// `life` as a function of the parameters; infinite if the limit is never reached.
LifeDistribution life_distribution(const WeightedDraws& draws, const Function& life);

/// The life of a new item, constant/driver: the logarithm of the driver, a wear rate, is normal
/// over items about that of driver(x) with standard deviation log_sd(x).
LifeDistribution life_distribution(const WeightedDraws& draws, double constant,
                                   const Function& driver, const Function& log_sd);

/// `now` in the unit of the life; `risk` in (0, 1), the tolerated probability that the life ends before the next inspection.
Life predict_life(const LifeDistribution& lives, double now, double risk);
inline Life predict_life(const WeightedDraws& draws, const Function& life, double now,
                         double risk) {
  return predict_life(life_distribution(draws, life), now, risk);
}

}  // namespace wearwell
