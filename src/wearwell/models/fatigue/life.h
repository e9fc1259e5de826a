#pragma once

#include <functional>
#include <vector>

#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// Lives whose laws are mixed: of an item of which the parameters are known as far as a posterior
/// knows them, or whose fatigue limit is one of a population.
class MixedLife {
 public:
  explicit MixedLife(LifeFamily family) : family_(family) {}

  /// A law about `center`: log10 of cycles, of the normal family cycles; infinite where life has no
  /// end. Weights sum to 1 over all laws.
  void add(double weight, double center, double sigma);

  /// Makes laws that no digit of interest tells apart one law of their common mean: a quadrature has
  /// hundreds of thousands. From B0.1 to B99.9 no life moves by more than one ten-thousandth.
  void merge();

  /// The probability that life [cycles] has ended by then.
  double cdf(double life) const;

  /// The life by which a share p has failed, 0 < p < 1; infinite where fewer ever do. NaN where a
  /// law with weight is none.
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
  double ended_ = 0;      // weight of the laws with an end
  double undefined_ = 0;  // weight of laws that are none
};

/// The centre of lives of items without fatigue limit, on the scale on which lives scatter: log10 of
/// cycles, of the normal family cycles.
double life_center(const SnLaw& law, const double* x, double log10_reversed);

/// How finely the population of fatigue limits is seen: in so many slices. `index` moves them from
/// one draw of parameters to the next.
struct LimitStrata {
  std::size_t count = 200, index = 0;
};

/// The laws whose mixture is the life under a fully reversed stress whose logarithm [Pa] is given, at parameters x: their shares, and
/// where they lie as `MixedLife::add` takes it. What is missing to 1 has no end.
void each_life(const SnLaw& law, const double* x, double log10_reversed, LimitStrata strata,
               const std::function<void(double share, double center, double sigma)>& take);

/// Adds the life under a fully reversed stress whose logarithm [Pa] is given, for parameters x of
/// this weight.
void add_life(MixedLife& lives, double weight, const SnLaw& law, const double* x,
              double log10_reversed, LimitStrata strata = {});

/// The life by which a share p of items has failed under one stress, on the scale on which lives
/// scatter. Infinite where fewer ever do.
double life_quantile(const SnLaw& law, const double* x, const Stress& stress, double p);

/// From that scale to cycles.
double cycles(const SnLaw& law, double at);

/// The probability that an item outlasts `life` [cycles] under one stress.
double survival(const SnLaw& law, const double* x, const Stress& stress, double life);

/// log10 of the fully reversed stress [Pa] under which a share `reliability` of items outlasts
/// `life` [cycles]; infinite where they do under any.
double log10_reversed_allowed(const SnLaw& law, const double* x, double life, double reliability);

/// The alternating stress [Pa] along a line that is as harmful as a fully reversed one.
double alternating_allowed(const SnLaw& law, const double* x, const StressLine& line,
                           double log10_reversed);

}  // namespace wearwell::fatigue
