#include "wearwell/infer/power_scaling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace wearwell {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

double sum(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// The square of the distance, from one side only; `x` ascends or descends.
double divergence(std::span<const double> x, std::span<const double> p, std::span<const double> q) {
  const double p_total = sum(p), q_total = sum(q);
  double p_sum = 0, q_sum = 0, integral = 0, bound = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    p_sum += p[i];
    q_sum += q[i];
    const double p_below = p_sum / p_total, q_below = q_sum / q_total;
    const double both = p_below + q_below;
    if (both == 0) continue;
    // P ln(P/M) + Q ln(Q/M) with t = (P - Q)/(P + Q), in a form that is accurate for nearly equal P
    // and Q, as for alpha near 1.
    const double t = (p_below - q_below) / both;
    const double shape =
        std::abs(t) == 1 ? 2 * std::numbers::ln2 : 2 * t * std::atanh(t) + std::log1p(-t * t);
    const double width = std::abs(x[i + 1] - x[i]);
    integral += width * both / 2 * shape;
    bound += width * both;
  }
  return bound > 0 ? integral / (bound * std::numbers::ln2) : 0;
}

/// The draws in ascending order, with their densities and weights.
struct Sorted {
  std::vector<std::size_t> order;
  std::vector<double> draws;
  std::vector<double> weights;
};

Sorted sort(std::span<const double> draws, std::span<const double> weights) {
  Sorted sorted;
  sorted.order.resize(draws.size());
  std::iota(sorted.order.begin(), sorted.order.end(), 0);
  std::sort(sorted.order.begin(), sorted.order.end(),
            [&](std::size_t a, std::size_t b) { return draws[a] < draws[b]; });
  for (const std::size_t i : sorted.order) {
    sorted.draws.push_back(draws[i]);
    sorted.weights.push_back(weights.empty() ? 1 : weights[i]);
  }
  return sorted;
}

double sensitivity(const Sorted& sorted, std::span<const double> log_component) {
  const auto [lowest, highest] = std::minmax_element(log_component.begin(), log_component.end());
  double gradients = 0;
  for (const double alpha : {0.99, 1.01}) {
    // Relative to the largest weight, to avoid overflow.
    const double largest = alpha > 1 ? *highest : *lowest;
    std::vector<double> scaled = sorted.weights;
    for (std::size_t i = 0; i < scaled.size(); ++i) {
      scaled[i] *= std::exp((alpha - 1) * (log_component[sorted.order[i]] - largest));
    }
    gradients += cumulative_jensen_shannon(sorted.draws, sorted.weights, scaled) /
                 std::abs(std::log2(alpha));
  }
  return gradients / 2;
}

void check_lengths(std::size_t draws, std::span<const double> component,
                   std::span<const double> weights) {
  if (component.size() != draws || (!weights.empty() && weights.size() != draws)) {
    throw std::invalid_argument("draws, log densities and weights of different lengths");
  }
}

/// Whether the draws are finite and vary.
bool usable(std::span<const double> draws, std::span<const double> weights) {
  if (draws.empty() || !all_finite(draws) || !all_finite(weights)) return false;
  if (!weights.empty() && !(sum(weights) > 0)) return false;
  const auto [low, high] = std::minmax_element(draws.begin(), draws.end());
  return *low < *high;
}

}  // namespace

double cumulative_jensen_shannon(std::span<const double> sorted, std::span<const double> p,
                                 std::span<const double> q) {
  const std::vector<double> x_down(sorted.rbegin(), sorted.rend());
  const std::vector<double> p_down(p.rbegin(), p.rend());
  const std::vector<double> q_down(q.rbegin(), q.rend());
  return std::sqrt(std::max(divergence(sorted, p, q), divergence(x_down, p_down, q_down)));
}

double power_scaling_sensitivity(std::span<const double> draws,
                                 std::span<const double> log_component,
                                 std::span<const double> weights) {
  check_lengths(draws.size(), log_component, weights);
  if (!usable(draws, weights) || !all_finite(log_component)) return nan;
  return sensitivity(sort(draws, weights), log_component);
}

PowerScaling power_scaling(std::span<const double> draws, std::span<const double> log_prior,
                           std::span<const double> log_likelihood,
                           std::span<const double> weights) {
  check_lengths(draws.size(), log_prior, weights);
  check_lengths(draws.size(), log_likelihood, weights);
  if (!usable(draws, weights)) return {nan, nan};
  const Sorted sorted = sort(draws, weights);
  return {all_finite(log_prior) ? sensitivity(sorted, log_prior) : nan,
          all_finite(log_likelihood) ? sensitivity(sorted, log_likelihood) : nan};
}

PowerScalingVerdict verdict(const PowerScaling& sensitivity) {
  if (std::isnan(sensitivity.prior) || std::isnan(sensitivity.likelihood)) {
    return PowerScalingVerdict::unknown;
  }
  if (sensitivity.prior < power_scaling_threshold) return PowerScalingVerdict::none;
  return sensitivity.likelihood < power_scaling_threshold
             ? PowerScalingVerdict::strong_prior_or_weak_likelihood
             : PowerScalingVerdict::prior_data_conflict;
}

}  // namespace wearwell
