#include "wearwell/prognosis/lives_against.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/math/quantile.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/study_lives.h"

namespace wearwell::prognosis {
namespace {

constexpr std::size_t most_points = 400;
constexpr double percents[] = {1, 10, 50};

// The life at points of a posterior.
struct AtPoints {
  std::vector<double> weight;
  std::vector<LifeDistribution> exact;
  std::vector<WeightedLives> lives;

  explicit AtPoints(const LifeOfResult& result) {
    const ThinnedPosterior few(result.posterior, most_points);
    weight = few.weights;
    exact.resize(weight.size());
    lives.resize(weight.size());
    tbb::parallel_for(std::size_t{0}, weight.size(), [&](std::size_t k) {
      const auto x = few.values.row(static_cast<Eigen::Index>(k));
      exact[k] = distribution_at(result.life, {x.data(), static_cast<std::size_t>(x.size())});
      lives[k] = represented_lives(exact[k].quantile);
    });
  }

  template <class Value>
  std::vector<double> each(const Value& value) const {
    std::vector<double> all(exact.size());
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) { all[k] = value(exact[k]); });
    return all;
  }
};

// P(a > b), ties by half: lives that never end are equal.
double outliving(const WeightedLives& a, const WeightedLives& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.points().size(); ++i) {
    const double life = a.points()[i];
    const double below = std::isfinite(life) ? b.cdf(life) : 1;
    double beyond = 0;
    if (!std::isfinite(life))
      for (std::size_t j = b.points().size(); j > 0 && std::isinf(b.points()[j - 1]); --j)
        beyond += b.weights()[j - 1];
    sum += a.weights()[i] * (below - 0.5 * beyond);
  }
  return sum;
}

// Values of all pairs. Empty if one is undetermined (never against never).
template <class Value>
std::optional<ComparedValue> over_pairs(const AtPoints& a, const AtPoints& b, double same,
                                        double confidence, const Value& value) {
  std::vector<WeightedValue> all(a.weight.size() * b.weight.size());
  tbb::parallel_for(std::size_t{0}, a.weight.size(), [&](std::size_t i) {
    for (std::size_t j = 0; j < b.weight.size(); ++j)
      all[i * b.weight.size() + j] = {value(i, j), a.weight[i] * b.weight[j]};
  });
  ComparedValue found;
  for (const WeightedValue& each : all) {
    if (std::isnan(each.value)) return {};
    found.mean += each.weight * each.value;
    found.larger += each.weight * (each.value > same ? 1 : each.value == same ? 0.5 : 0);
  }
  found.q05 = weighted_quantile(all, 0.05);
  found.q50 = weighted_quantile(all, 0.5);
  found.q95 = weighted_quantile(all, 0.95);
  found.lower = weighted_quantile(all, 1 - confidence);
  return found;
}

}  // namespace

LivesAgainst lives_against(const LifeOfResult& life, const LifeOfResult& other, double confidence,
                           std::optional<double> use) {
  const AtPoints a(life), b(other);
  LivesAgainst found;
  found.confidence = confidence;
  found.outlives = *over_pairs(a, b, 0.5, confidence, [&](std::size_t i, std::size_t j) {
    return outliving(a.lives[i], b.lives[j]);
  });
  for (const double percent : percents) {
    const auto quantile = [&](const LifeDistribution& of) { return of.quantile(percent / 100); };
    const std::vector<double> above = a.each(quantile), below = b.each(quantile);
    const auto ratio = over_pairs(
        a, b, 1, confidence, [&](std::size_t i, std::size_t j) { return above[i] / below[j]; });
    if (ratio)
      found.ratios.push_back({percent, *ratio});
    else
      found.without_ratio.push_back(percent);
  }
  if (use) {
    const auto failed = [&](const LifeDistribution& of) { return of.cdf(*use); };
    const std::vector<double> here = a.each(failed), there = b.each(failed);
    found.survival = over_pairs(a, b, 0, confidence,
                                [&](std::size_t i, std::size_t j) { return there[j] - here[i]; });
  }
  return found;
}

}  // namespace wearwell::prognosis
