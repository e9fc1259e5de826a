#include "wearwell/predict/prediction.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "wearwell/base/rng.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/math/quantile.h"
#include "wearwell/math/root.h"
#include "wearwell/predict/item_mixture.h"

namespace wearwell {
namespace {

// For t = y, or log y for the lognormal family.
double density(const ObservationDistribution& distribution, double t) {
  const double z = (distribution.location - t) / distribution.scale;
  if (!(std::abs(z) < 9)) return 0;
  constexpr double sqrt_2_pi = 2.50662827463100050241576528481;
  return std::exp(-0.5 * z * z) / (distribution.scale * sqrt_2_pi);
}

// A mixture of measurements: each draw gives one distribution, or one for each of some items.
struct Mixture {
  ObservationFamily family;
  std::vector<double> weight;
  std::vector<ObservationDistribution> distribution;
  double middle = 0, width = 0;  // approximate location and width: medians over the draws

  double cdf(double y) const {
    check_stop();
    const bool lognormal = family == ObservationFamily::lognormal;
    if (lognormal && y <= 0) return 0;
    const double t = lognormal ? std::log(y) : y;
    double sum = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) sum += weight[i] * distribution[i].cdf(t);
    return sum;
  }

  double quantile(double p) const {
    if (!std::isfinite(middle) || !std::isfinite(width)) return std::nan("");
    // Evaluating all distributions is expensive: a few of them locate the quantile approximately,
    // and Halley's method then needs two steps.
    constexpr std::size_t few = 256;
    if (weight.size() > 4 * few) {
      const double near = some(few).bracketed(p);
      const double exact = polished(p, near);
      if (std::isfinite(exact)) return exact;
    }
    return bracketed(p);
  }

 private:
  // Evenly chosen among all.
  Mixture some(std::size_t count) const {
    Mixture chosen{family, {}, {}, middle, width};
    double total = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = i * weight.size() / count;
      chosen.weight.push_back(weight[at]);
      chosen.distribution.push_back(distribution[at]);
      total += weight[at];
    }
    for (double& each : chosen.weight) each /= total;
    return chosen;
  }

  // Halley's method from a point near the quantile; NaN if it does not converge at once.
  double polished(double p, double near) const {
    constexpr double close = 1e-4;  // the error of the next step is cubic
    const bool lognormal = family == ObservationFamily::lognormal;
    double t = lognormal ? std::log(near) : near;
    for (int step = 0; step < 8; ++step) {
      check_stop();
      double below = 0, slope = 0, bend = 0;
      for (std::size_t i = 0; i < weight.size(); ++i) {
        const double each = weight[i] * density(distribution[i], t);
        below += weight[i] * distribution[i].cdf(t);
        slope += each;
        if (each > 0)
          bend += each * (distribution[i].location - t) /
                  (distribution[i].scale * distribution[i].scale);
      }
      const double newton = (below - p) / slope;
      t -= newton / std::clamp(1 - 0.5 * newton * bend / slope, 0.5, 2.0);
      if (!std::isfinite(t)) break;
      if (std::abs(below - p) <= close) return lognormal ? std::exp(t) : t;
    }
    return std::nan("");
  }

  double bracketed(double p) const {
    constexpr double most = std::numeric_limits<double>::max();
    const double step = std::max(width, 1e-12 * std::abs(middle));
    const double root = solve_increasing([&](double y) { return cdf(y) - p; }, middle, step,
                                         {.relative = 1e-7}, -most, most);
    return std::abs(root) == most ? std::nan("") : root;
  }
};

Mixture mixture(const WeightedDraws& draws, const Function& mean, const Function& sd,
                ObservationFamily family, const ItemFunction& item, std::size_t points) {
  const DominantDraws dominant(draws);
  const std::size_t n = dominant.rows.size();
  const std::size_t strata = item ? std::clamp<std::size_t>(points / n, 1, 100) : 1;
  std::vector<double> z = {0};
  Mixture all{family, {}, {}};
  std::vector<WeightedValue> means, sds;
  for (std::size_t i = 0; i < n; ++i) {
    check_stop();
    const double* x = draws.values.row(dominant.rows[i]).data();
    const double s = sd(x);
    if (item) stratified_normals(i, strata, z);
    for (const double each : z) {
      const double weight = dominant.weights[i] / static_cast<double>(strata);
      const double m = item ? item(x, each) : mean(x);
      if (std::isnan(m) || !(s > 0)) return {family, {}, {}, std::nan(""), std::nan("")};
      all.weight.push_back(weight);
      all.distribution.emplace_back(family, m, s);
      if (each == z[z.size() / 2]) {
        means.push_back({m, dominant.weights[i]});
        sds.push_back({s, dominant.weights[i]});
      }
    }
  }
  all.middle = weighted_quantile(means, 0.5);
  all.width = weighted_quantile(sds, 0.5);
  return all;
}

}  // namespace

DominantDraws::DominantDraws(const WeightedDraws& draws) {
  constexpr double negligible = 1e-6;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(draws.values.rows()));
  std::iota(order.begin(), order.end(), 0);
  if (!draws.lower.empty()) {
    // Symmetric nodes have weights that are equal but for rounding errors, which must not order them.
    Eigen::VectorXd size = draws.weights;
    Rng rng(0, 0);
    for (double& each : size) each *= 1 + rng.uniform(0, 1e-6);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return size[a] > size[b]; });
  }
  double total = 0;
  for (const Eigen::Index i : order) {
    if (total > 1 - negligible) break;
    rows.push_back(i);
    weights.push_back(draws.weights[i]);
    total += draws.weights[i];
  }
  for (double& weight : weights) weight /= total;
}

Prediction predict(const WeightedDraws& draws, const Function& mean, const Function& sd,
                   ObservationFamily family, const ItemFunction& item, std::size_t points,
                   const Ends& ends) {
  const QuantityDistribution truth(draws, mean);
  const Mixture measurement = mixture(draws, mean, sd, family, item, points);
  return {truth.mean(), truth.quantile(ends.lower), truth.quantile(ends.upper),
          measurement.quantile(ends.lower), measurement.quantile(ends.upper)};
}

LifeDistribution life_distribution(const WeightedDraws& draws, const Function& life) {
  const auto lives = std::make_shared<const QuantityDistribution>(draws, life);
  return {[lives](double at) { return lives->cdf(at); },
          [lives](double p) { return lives->quantile(p); }};
}

LifeDistribution life_distribution(const WeightedDraws& draws, double constant,
                                   const Function& driver, const Function& log_sd) {
  const auto items = std::make_shared<const ItemMixture>(draws, driver, log_sd);
  return {[=](double at) { return at > 0 ? 1 - items->cdf(constant / at) : 0.0; },
          [=](double p) { return constant / items->quantile(1 - p); }};
}

Life predict_life(const LifeDistribution& lives, double now, double risk) {
  const double reached = lives.cdf(now);
  const double wait = lives.quantile(reached + risk * (1 - reached)) - now;
  return {lives.quantile(0.01),
          lives.quantile(0.1),
          lives.quantile(0.5),
          lives.quantile(0.05),
          lives.quantile(0.95),
          std::max(0.0, wait),
          reached};
}

}  // namespace wearwell
