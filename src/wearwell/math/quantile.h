#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace wearwell {

/// The p-quantile of values in ascending order, interpolated between the two nearest: R's type 7
/// (Hyndman and Fan 1996, definition 7). `sorted` is not empty, 0 <= p <= 1.
inline double quantile(std::span<const double> sorted, double p) {
  // Counts from 1, as in R: near an integer position, rounding determines the returned value.
  const double position = 1 + static_cast<double>(sorted.size() - 1) * p;
  const double below = std::floor(position);
  const auto i = static_cast<std::size_t>(below) - 1;
  if (position == below) return sorted[i];
  return std::lerp(sorted[i], sorted[i + 1], position - below);
}

/// The p-quantile of weighted draws (for example from importance sampling), `weights[i]` belonging
/// to `sorted[i]`: the weighted type 7 of Akinshin (2023), arXiv:2304.07265. Each value counts by
/// its share of a window of mass 1/n around p, where n = (sum w)^2 / sum w^2 is Kish's effective
/// sample size; equal weights give type 7. Weights are not negative, their sum is positive, and
/// their scale does not matter.
inline double quantile(std::span<const double> sorted, std::span<const double> weights, double p) {
  double sum = 0, squares = 0;
  for (const double w : weights) {
    sum += w;
    squares += w * w;
  }
  const double n = sum * (sum / squares);
  const double window = (n - 1) * p;  // from window/n to (window + 1)/n of the mass
  double mass = 0, covered = 0, value = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    mass += weights[i];
    const double reached = std::clamp(mass / sum * n - window, 0.0, 1.0);
    if (reached > covered) value += (reached - covered) * sorted[i];  // the value may be infinite
    covered = reached;
  }
  // Rounding may leave the end of the window uncovered; this part belongs to the last value.
  return covered < 1 ? value + (1 - covered) * sorted.back() : value;
}

struct WeightedValue {
  double value, weight;
};

/// The smallest value at which the cumulative weight reaches p. Weights sum to 1; `all` is not
/// empty and is reordered.
inline double weighted_quantile(std::span<WeightedValue> all, double p) {
  const auto by_value = [](const WeightedValue& a, const WeightedValue& b) {
    return a.value < b.value;
  };
  auto begin = all.begin(), end = all.end();
  double below = 0;
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, by_value);
    double left = below;
    for (auto at = begin; at != middle; ++at) left += at->weight;
    if (left >= p) {
      end = middle;
    } else {
      begin = middle;
      below = left;
    }
  }
  return begin->value;
}

}  // namespace wearwell
