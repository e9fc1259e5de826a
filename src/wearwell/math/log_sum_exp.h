#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace wearwell {

/// log(sum(exp(values))) without overflow; of at least one value.
inline double log_sum_exp(std::span<const double> values) {
  const double highest = *std::max_element(values.begin(), values.end());
  if (!std::isfinite(highest)) return highest;
  double sum = 0;
  for (const double value : values) sum += std::exp(value - highest);
  return highest + std::log(sum);
}

}  // namespace wearwell
