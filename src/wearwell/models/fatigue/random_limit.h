#pragma once

#include "wearwell/math/dual.h"
#include "wearwell/models/fatigue/life_test.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell::fatigue {

/// The life of items with random fatigue limits, under one stress (Pascual and Meeker 1999, eqs. 2
/// to 5): log10 of the limit V has a location-scale distribution; given V below log10 S_f, log10
/// life has a distribution about (log10(S_f - 10^V) - log10_a)/b with scale sigma; at or above it,
/// life has no end.
template <class T>
struct LimitedLife {
  StandardDistribution life, limit;
  T log10_reversed, log10_a, b, sigma;
  T location, scale;  ///< of the limit
};

/// For a model with an integral over the limit (SnLaw::integrated), at its parameters.
template <class T>
LimitedLife<T> limited_life(const SnLaw& law, const T* x, const T& log10_reversed) {
  const T* limit = x + law.limit_index();
  return {law.standard(), *law.limit,           log10_reversed, x[0],
          x[1],           x[law.sigma_index()], limit[0],       limit[1]};
}

/// The log of a probability or density, and its derivatives by the numbers of LimitedLife.
struct LimitedLifeSlopes {
  double value = 0;
  double by_log10_reversed = 0, by_log10_a = 0, by_b = 0, by_sigma = 0;
  double by_location = 0, by_scale = 0;
};

/// log of the density of log10 life at `at` (failure), or of the probability that life is beyond it
/// (runout), below it (left) or between `at` and `until` (interval): an integral over the limit by
/// adaptive Gauss-Kronrod, to 1e-10. Minus infinity, with derivatives 0, where it underflows.
LimitedLifeSlopes log_probability_and_slopes(const LimitedLife<double>& item, Outcome outcome,
                                             double at, double until);

/// The same by adaptive integration only: the reference of the faster rule of limit_lattice.h.
LimitedLifeSlopes adaptive_probability_and_slopes(const LimitedLife<double>& item, Outcome outcome,
                                                  double at, double until);

/// The same for a formula's scalar: double or Dual.
template <class T>
T log_probability(const LimitedLife<T>& item, Outcome outcome, double at, double until) {
  const LimitedLifeSlopes y = log_probability_and_slopes(
      {item.life, item.limit, scalar(item.log10_reversed), scalar(item.log10_a), scalar(item.b),
       scalar(item.sigma), scalar(item.location), scalar(item.scale)},
      outcome, at, until);
  return chained(item.log10_reversed, y.value, y.by_log10_reversed) +
         chained(item.log10_a, 0, y.by_log10_a) + chained(item.b, 0, y.by_b) +
         chained(item.sigma, 0, y.by_sigma) + chained(item.location, 0, y.by_location) +
         chained(item.scale, 0, y.by_scale);
}

}  // namespace wearwell::fatigue
