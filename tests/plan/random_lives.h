#pragma once

#include <cmath>
#include <vector>

#include "wearwell/base/rng.h"
#include "wearwell/plan/life_ahead.h"

namespace wearwell::plan {

/// A life of a random Weibull distribution, some of it passed in every second case.
inline LifeAhead random_life(Rng& rng, double scale, int points = 300) {
  const double shape = 0.8 + 3 * rng.uniform(), of_unit = scale * (0.5 + rng.uniform());
  std::vector<double> life;
  for (int i = 0; i < points; ++i)
    life.push_back(of_unit * std::pow(-std::log1p(-(i + 0.5) / points), 1 / shape));
  const double passed = rng.uniform() < 0.5 ? 0 : 0.06 * rng.uniform();
  return {passed, prognosis::WeightedLives(life, std::vector<double>(life.size(), 1))};
}

/// A life drawn from it: 0 if the threshold is passed.
inline double drawn(const LifeAhead& life, Rng& rng) {
  const double u = rng.uniform();
  return u < life.passed() ? 0 : life.latest(u);
}

/// The times of a set of multiples of a step, bit k standing for (k + first) steps.
inline std::vector<double> subset(unsigned bits, double step, int first) {
  std::vector<double> times;
  for (int k = 0; bits >> k; ++k)
    if (bits >> k & 1U) times.push_back(step * (k + first));
  return times;
}

inline bool keeps_bound(const std::vector<double>& risks, double bound) {
  for (const double each : risks)
    if (each > bound + 1e-9) return false;
  return true;
}

}  // namespace wearwell::plan
