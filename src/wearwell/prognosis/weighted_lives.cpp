#include "wearwell/prognosis/weighted_lives.h"

#include <algorithm>
#include <boost/sort/spreadsort/float_sort.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace wearwell::prognosis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Point {
  double life, weight;
};

// By the bits of the life: half of what a monitor computed was comparisons.
void sort(std::vector<Point>& points) {
  const auto bits = [](const Point& point, unsigned shift) {
    return boost::sort::spreadsort::float_mem_cast<double, std::int64_t>(point.life) >> shift;
  };
  const auto less = [](const Point& a, const Point& b) { return a.life < b.life; };
  boost::sort::spreadsort::float_sort(points.begin(), points.end(), bits, less);
}

}  // namespace

WeightedLives::WeightedLives(std::span<const double> life, std::span<const double> weight) {
  std::vector<Point> points;
  points.reserve(life.size());
  double sum = 0;
  for (std::size_t i = 0; i < life.size(); ++i) {
    if (!(weight[i] > 0) || std::isnan(life[i])) continue;
    points.push_back({life[i], weight[i]});
    sum += weight[i];
  }
  sort(points);
  for (auto* each : {&life_, &weight_, &cumulated_}) each->reserve(points.size());
  double before = 0;
  for (const auto& [place, all] : points) {
    const double share = all / sum;
    if (!life_.empty() && life_.back() == place) {
      weight_.back() += share;
      cumulated_.back() += 0.5 * share;
    } else {
      life_.push_back(place);
      weight_.push_back(share);
      cumulated_.push_back(before + 0.5 * share);
    }
    before += share;
  }
}

double WeightedLives::cdf(double x) const {
  const auto above = std::upper_bound(life_.begin(), life_.end(), x);
  if (above == life_.begin()) return 0;
  const auto i = static_cast<std::size_t>(above - life_.begin());
  const double done = cumulated_[i - 1] + 0.5 * weight_[i - 1];
  if (i == life_.size() || life_[i - 1] == infinity || life_[i] == infinity) return done;
  const double share = (x - life_[i - 1]) / (life_[i] - life_[i - 1]);
  return cumulated_[i - 1] + share * (cumulated_[i] - cumulated_[i - 1]);
}

double WeightedLives::quantile(double p) const {
  if (life_.empty()) return std::nan("");
  const auto above = std::upper_bound(cumulated_.begin(), cumulated_.end(), p);
  if (above == cumulated_.begin()) return life_.front();
  const auto i = static_cast<std::size_t>(above - cumulated_.begin());
  if (life_[i - 1] == infinity || i == life_.size()) return life_[i - 1];
  if (life_[i] == infinity) {
    return p < cumulated_[i - 1] + 0.5 * weight_[i - 1] ? life_[i - 1] : infinity;
  }
  const double share = (p - cumulated_[i - 1]) / (cumulated_[i] - cumulated_[i - 1]);
  return life_[i - 1] + share * (life_[i] - life_[i - 1]);
}

double WeightedLives::mean_up_to(double x) const {
  // The integral of the share that still lives: straight between points.
  if (life_.empty()) return std::nan("");
  if (x <= life_.front()) return x;
  double lived = life_.front();
  for (std::size_t i = 0; i < life_.size() && life_[i] < x; ++i) {
    if (i + 1 == life_.size() || life_[i + 1] == infinity) {
      const double left = i + 1 == life_.size() ? 0 : 1 - cumulated_[i] - 0.5 * weight_[i];
      return left > 0 ? lived + left * (x - life_[i]) : lived;
    }
    const double whole = life_[i + 1] - life_[i], part = std::min(x - life_[i], whole);
    const double rise = (cumulated_[i + 1] - cumulated_[i]) * part / whole;
    lived += part * (1 - cumulated_[i] - 0.5 * rise);
  }
  return lived;
}

WeightedLives WeightedLives::beyond(double x) const {
  const auto above = std::upper_bound(life_.begin(), life_.end(), x);
  if (above == life_.begin()) {
    std::vector<double> life(life_);
    for (double& each : life) each -= x;
    return WeightedLives(life, weight_);
  }
  const auto first = static_cast<std::size_t>(above - life_.begin());
  std::vector<double> life, weight;
  for (std::size_t i = first; i < life_.size(); ++i) {
    life.push_back(life_[i] - x);
    weight.push_back(weight_[i]);
  }
  if (life.empty()) return {};
  // Between two points a part of both is there: a point at once makes up for the difference.
  const double before = 1 - cdf(x) - std::accumulate(weight.begin(), weight.end(), 0.0);
  if (before > 0) {
    life.insert(life.begin(), 0);
    weight.insert(weight.begin(), before);
  } else {
    weight.front() += before;
  }
  return WeightedLives(life, weight);
}

}  // namespace wearwell::prognosis
