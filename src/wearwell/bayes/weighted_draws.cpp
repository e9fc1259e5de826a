#include "wearwell/bayes/weighted_draws.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <numeric>

#include "wearwell/math/quantile.h"

namespace wearwell {

Distribution::Distribution(const WeightedDraws& draws,
                           const std::function<double(const double* x)>& quantity)
    : cells_(!draws.lower.empty()) {
  const Eigen::Index n = draws.values.rows();
  std::vector<double> center(n), half_width(n, 0.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double at_node = quantity(draws.values.row(i).data());
    double middle = at_node, variance = 0;
    for (std::size_t axis = 0; axis < draws.lower.size(); ++axis) {
      const double a = quantity(draws.lower[axis].row(i).data());
      const double b = quantity(draws.upper[axis].row(i).data());
      if (!std::isfinite(a) || !std::isfinite(b)) continue;
      middle += 0.5 * (a + b) - at_node;
      variance += 0.25 * (b - a) * (b - a);
    }
    center[i] = middle;
    half_width[i] = std::sqrt(variance);
  }

  std::vector<Eigen::Index> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return center[a] < center[b]; });
  for (const Eigen::Index i : order) {
    center_.push_back(center[i]);
    half_width_.push_back(half_width[i]);
    weight_.push_back(draws.weights[i]);
  }
}

double Distribution::mean() const {
  return std::inner_product(center_.begin(), center_.end(), weight_.begin(), 0.0);
}

double Distribution::sd() const {
  const double m = mean();
  double variance = 0;
  for (std::size_t i = 0; i < center_.size(); ++i) {
    variance += weight_[i] * (std::pow(center_[i] - m, 2) + std::pow(half_width_[i], 2) / 3);
  }
  // n/(n-1) for draws, so that the sd is R's.
  const auto n = static_cast<double>(center_.size());
  return std::sqrt(cells_ ? variance : variance * n / (n - 1));
}

double Distribution::cdf(double x) const {
  double sum = 0;
  for (std::size_t i = 0; i < center_.size(); ++i) {
    const double d = x - center_[i], h = half_width_[i];
    sum += d >= h ? weight_[i] : d <= -h ? 0 : weight_[i] * 0.5 * (1 + d / h);
  }
  return sum;
}

double Distribution::quantile(double p) const {
  const std::size_t n = center_.size();
  if (!cells_) {
    // Between an end that is never reached (infinity) and a neighbour there is nothing to
    // interpolate.
    const double q = wearwell::quantile(std::span<const double>(center_), p);
    return std::isnan(q) ? center_.back() : q;
  }
  double below = 0;
  std::size_t i = 0;
  while (i + 1 < n && below + weight_[i] < p) below += weight_[i++];
  if (!std::isfinite(center_[i])) return center_[i];
  double reach = 2 * half_width_[i] + 1e-12 * std::abs(center_[i]);
  double a = center_[i] - reach, b = center_[i] + reach;
  const auto excess = [&](double x) { return cdf(x) - p; };
  while (excess(a) > 0) a -= reach *= 2;
  while (excess(b) < 0 && std::isfinite(b)) b += reach *= 2;
  if (!std::isfinite(b)) return b;
  std::uintmax_t iterations = 60;
  const auto [left, right] = boost::math::tools::toms748_solve(
      excess, a, b, boost::math::tools::eps_tolerance<double>(40), iterations);
  return 0.5 * (left + right);
}

WeightedSampler::WeightedSampler(const WeightedDraws& draws) : draws_(draws) {
  cumulated_.resize(static_cast<std::size_t>(draws.weights.size()));
  std::partial_sum(draws.weights.begin(), draws.weights.end(), cumulated_.begin());
}

Eigen::VectorXd WeightedSampler::operator()(Rng& rng) const {
  const double u = rng.uniform() * cumulated_.back();
  const auto found = std::lower_bound(cumulated_.begin(), cumulated_.end(), u);
  const Eigen::Index i = found - cumulated_.begin();
  Eigen::VectorXd x = draws_.values.row(i);
  for (std::size_t axis = 0; axis < draws_.lower.size(); ++axis) {
    const double t = rng.uniform();
    x +=
        ((1 - t) * draws_.lower[axis].row(i) + t * draws_.upper[axis].row(i) - draws_.values.row(i))
            .transpose();
  }
  return x;
}

}  // namespace wearwell
