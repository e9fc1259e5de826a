#include "wearwell/study/numerical_error.h"

#include <algorithm>
#include <cmath>

namespace wearwell {

double relative_difference(double value, double other, double size) {
  if (value == other || (std::isnan(value) && std::isnan(other))) return 0;
  if (!std::isfinite(value) || !std::isfinite(other)) return 1;
  return std::abs(value - other) / std::max(std::abs(value), 1e-3 * std::abs(size));
}

void estimate_numerical_errors(std::vector<QuantityQuantiles>& answers,
                               const std::vector<QuantityQuantiles>& coarse) {
  constexpr double margin = 2;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    QuantityQuantiles& q = answers[i];
    const QuantityQuantiles& c = coarse[i];
    const auto differ = [&](double value, double other) {
      return margin * relative_difference(value, other, q.q50);
    };
    double error = q.numerical_error.value_or(0);
    if (!q.numerical_error) {
      error = std::max({differ(q.q05, c.q05), differ(q.q50, c.q50), differ(q.q95, c.q95),
                        differ(q.b1, c.b1), differ(q.b10, c.b10), differ(q.b50, c.b50)});
      if (q.bound && c.bound) error = std::max(error, differ(*q.bound, *c.bound));
      if (q.upper_bound && c.upper_bound)
        error = std::max(error, differ(*q.upper_bound, *c.upper_bound));
    }
    // A mean that stands alone.
    if (q.mean && c.mean && std::isnan(q.q50))
      error = std::max(error, margin * relative_difference(*q.mean, *c.mean, *q.mean));
    if (q.predictive && c.predictive) error = std::max(error, differ(*q.predictive, *c.predictive));
    q.numerical_error = error;
  }
}

std::optional<double> largest_numerical_error(const std::vector<QuantitySummary>& quantities,
                                              bool bounds) {
  double largest = 0;
  for (const QuantitySummary& each : quantities) {
    if (each.best().predictive.has_value() == bounds)
      largest = std::max(largest, each.best().numerical_error.value_or(0));
  }
  return largest > least_numerical_error ? std::optional(largest) : std::nullopt;
}

}  // namespace wearwell
