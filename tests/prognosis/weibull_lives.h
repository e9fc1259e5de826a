#pragma once

#include <boost/math/distributions/weibull.hpp>

#include <vector>

#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::prognosis {

/// Points of the same weight, at the middle of each in probability.
inline WeightedLives weibull_lives(double shape, double scale, int count = 4000) {
  const boost::math::weibull_distribution<> law(shape, scale);
  std::vector<double> life;
  for (int i = 0; i < count; ++i) life.push_back(quantile(law, (i + 0.5) / count));
  return {life, std::vector<double>(life.size(), 1)};
}

}  // namespace wearwell::prognosis
