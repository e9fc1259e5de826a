#include "wearwell/infer/pareto_smoothing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/math/constants.h"
#include "wearwell/math/log_sum_exp.h"

namespace wearwell {
double GeneralizedPareto::quantile(double p) const {
  const double survival = std::log1p(-p);
  return std::abs(k) < 1e-12 ? -sigma * survival : sigma * std::expm1(-k * survival) / k;
}

GeneralizedPareto fit_generalized_pareto(std::span<const double> ascending) {
  const auto n = static_cast<double>(ascending.size());
  const int grid = 30 + static_cast<int>(std::floor(std::sqrt(n)));
  const double quartile = ascending[static_cast<std::size_t>(std::floor(n / 4 + 0.5)) - 1];
  std::vector<double> theta, log_profile;
  for (int j = 1; j <= grid; ++j) {
    theta.push_back(1 / ascending.back() + (1 - std::sqrt(grid / (j - 0.5))) / (3 * quartile));
    double shape = 0;
    for (const double x : ascending) shape += std::log1p(-theta.back() * x);
    shape /= n;
    log_profile.push_back(n * (std::log(-theta.back() / shape) - shape - 1));
  }
  const double total = log_sum_exp(log_profile);
  double mean = 0;
  for (std::size_t j = 0; j < theta.size(); ++j)
    mean += theta[j] * std::exp(log_profile[j] - total);
  GeneralizedPareto distribution;
  distribution.k = 0;
  for (const double x : ascending) distribution.k += std::log1p(-mean * x);
  distribution.k /= n;
  distribution.sigma = -distribution.k / mean;
  constexpr double prior_weight = 10, prior_k = 0.5;
  distribution.k = (distribution.k * n + prior_weight * prior_k) / (n + prior_weight);
  if (std::isnan(distribution.k)) distribution.k = infinity;
  return distribution;
}

double pareto_smooth(std::vector<double>& log_weights) {
  const auto draws = static_cast<double>(log_weights.size());
  const auto tail =
      static_cast<std::size_t>(std::ceil(std::min(0.2 * draws, 3 * std::sqrt(draws))));
  const double highest = *std::max_element(log_weights.begin(), log_weights.end());
  for (double& each : log_weights) each -= highest;
  if (tail < 5) return infinity;
  std::vector<std::size_t> order(log_weights.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(log_weights[a], a) < std::make_pair(log_weights[b], b);
  });
  const std::size_t first = order.size() - tail;
  const double cutoff = std::exp(log_weights[order[first - 1]]);
  // All equal: the observation has no influence.
  if (!(log_weights[order[first]] < 0)) return 0;
  std::vector<double> excess;
  for (std::size_t i = first; i < order.size(); ++i) {
    excess.push_back(std::exp(log_weights[order[i]]) - cutoff);
  }
  const GeneralizedPareto distribution = fit_generalized_pareto(excess);
  if (std::isfinite(distribution.k)) {
    for (std::size_t i = 0; i < tail; ++i) {
      const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(tail);
      log_weights[order[first + i]] = std::min(0.0, std::log(distribution.quantile(p) + cutoff));
    }
  }
  return distribution.k;
}

double khat_threshold(double draws) {
  return std::min(1 - 1 / std::log10(draws), 0.7);
}

}  // namespace wearwell
