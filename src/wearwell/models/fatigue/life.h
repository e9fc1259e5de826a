#pragma once

#include <functional>
#include <vector>

#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// Lives as mixtures of distributions: of an item with uncertain parameters, by the posterior, or
/// with a fatigue limit from a population.
class MixedLife {
 public:
  explicit MixedLife(LifeFamily family) : family_(family) {}

  /// A distribution about `center`: log10 of cycles, for the normal family cycles; infinite if life
  /// has no end. Weights sum to 1 over all distributions.
  void add(double weight, double center, double sigma);

  /// Merges distributions that are nearly equal into one with their common mean: a quadrature has
  /// hundreds of thousands. From B0.1 to B99.9 no life changes by more than one ten-thousandth.
  void merge();

  /// The probability that life [cycles] has ended by then.
  double cdf(double life) const;

  /// The life by which a share p has failed, 0 < p < 1; infinite if fewer ever do. NaN if a
  /// distribution with weight is not a number.
  double quantile(double p) const;

  /// The density of log10 life.
  double density(double log10_life) const;

 private:
  struct Sums {
    double cdf = 0, density = 0;
  };
  Sums sums(double at) const;
  StandardDistribution standard() const;

  LifeFamily family_;
  std::vector<double> weight_, center_, inverse_sigma_;
  double ended_ = 0;      // weight of the distributions with an end
  double undefined_ = 0;  // weight of distributions that are not a number
};

/// The center of lives of items without fatigue limit, on the scale on which lives scatter: log10
/// of cycles, for the normal family cycles.
double life_center(const SnLaw& law, const double* x, double log10_reversed);

/// The number of slices of the population of fatigue limits. `index` moves them from one draw of
/// parameters to the next.
struct LimitStrata {
  std::size_t count = 200, index = 0;
};

/// The distributions whose mixture is the life under a fully reversed stress with the given
/// logarithm [Pa], at parameters x: their weights, and their location in the form of
/// `MixedLife::add`. The weight missing to 1 has no end.
void each_life(const SnLaw& law, const double* x, double log10_reversed, LimitStrata strata,
               const std::function<void(double share, double center, double sigma)>& take);

/// Adds the life under a fully reversed stress with the given logarithm [Pa], for parameters x of
/// this weight.
void add_life(MixedLife& lives, double weight, const SnLaw& law, const double* x,
              double log10_reversed, LimitStrata strata = {});

/// The life by which a share p of items has failed under one stress, on the scale on which lives
/// scatter. Infinite if fewer ever do.
double life_quantile(const SnLaw& law, const double* x, const Stress& stress, double p);

/// From that scale to cycles.
double cycles(const SnLaw& law, double at);

/// The probability that an item outlasts `life` [cycles] under one stress.
double survival(const SnLaw& law, const double* x, const Stress& stress, double life);

/// log10 of the fully reversed stress [Pa] under which a share `reliability` of items outlasts
/// `life` [cycles]; infinite if they do under any stress.
double log10_reversed_allowed(const SnLaw& law, const double* x, double life, double reliability);

/// The alternating stress [Pa] along a line that is as damaging as a fully reversed one.
double alternating_allowed(const SnLaw& law, const double* x, const StressLine& line,
                           double log10_reversed);

}  // namespace wearwell::fatigue
