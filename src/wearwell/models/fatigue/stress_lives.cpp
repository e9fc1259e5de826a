#include "wearwell/models/fatigue/stress_lives.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/life.h"

namespace wearwell::fatigue {
namespace {

constexpr std::size_t slices_of_a_point = 40;

// One distribution in the mixture of a point's lives; `share` of its parts follow it.
struct LifeComponent {
  double share, center, sigma;
};

// Of one point of the posterior.
struct PointLives {
  std::vector<LifeComponent> laws;
  double endless = 0;  // the share with infinite life
  bool defined = true;
};

PointLives lives_of_point(const SnLaw& law, const double* x, const Stress& stress,
                          std::size_t index) {
  PointLives lives;
  const double log10_reversed = law.log10_reversed(x, stress);
  double ended = 0;
  each_life(law, x, log10_reversed, {slices_of_a_point, index},
            [&](double share, double center, double sigma) {
              if (!(share > 0) || center == infinity) return;
              if (std::isnan(center) || !(sigma > 0)) {
                lives.defined = false;
                return;
              }
              lives.laws.push_back({share, center, sigma});
              ended += share;
            });
  lives.endless = std::max(0.0, 1 - ended);
  if (lives.endless < 1e-12) lives.endless = 0;
  return lives;
}

// Sums of probabilities that may underflow individually.
double log_survival_of(const SnLaw& law, const PointLives& lives, double log10_life) {
  const double at = law.logarithmic() ? log10_life : std::pow(10, log10_life);
  if (lives.laws.size() == 1 && lives.endless == 0)
    return log_survival_and_slope(law.standard(), (at - lives.laws[0].center) / lives.laws[0].sigma)
        .value;
  double sum = lives.endless;
  for (const LifeComponent& each : lives.laws)
    sum += each.share *
           std::exp(log_survival_and_slope(law.standard(), (at - each.center) / each.sigma).value);
  return sum > 0 ? std::log(sum) : -infinity;
}

// The grid of lives: from where hardly any has ended to where no distribution of non-negligible
// weight has any left, in even steps, and then in growing ones.
std::vector<double> places_of(const SnLaw& law, const std::vector<PointLives>& points,
                              std::span<const double> weight) {
  constexpr double far = 6, light = 1e-7, step_in_sigma = 0.1, growth = 1.05;
  constexpr double finest = 0.002, coarsest = 0.05;
  const double end = std::log10(StressLives::most_cycles);
  double low = infinity, high = -infinity, least = infinity;
  const bool skewed = law.standard() == StandardDistribution::smallest_extreme_value;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const LifeComponent& each : points[i].laws) {
      if (!(weight[i] * each.share > light)) continue;
      double from = each.center - (skewed ? 2.5 * far : far) * each.sigma;
      double until = each.center + far * each.sigma, sigma = each.sigma;
      if (!law.logarithmic()) {
        until = std::log10(std::max(1.0, until));
        sigma = each.sigma / std::max(each.center, each.sigma) / std::log(10.0);
        from = std::log10(std::max({1.0, from, 1e-4 * std::max(each.center, each.sigma)}));
      }
      low = std::min(low, from);
      high = std::max(high, until);
      least = std::min(least, sigma);
    }
  }
  if (!(low < end)) return {0, end};
  low = std::max(low, -3.0);
  high = std::clamp(high, low + 0.01, end);
  double step = std::clamp(step_in_sigma * least, finest, coarsest);
  std::vector<double> at;
  for (double x = low; x < high; x += step) at.push_back(x);
  for (double x = high; x < end; x += step, step *= growth) at.push_back(x);
  at.push_back(end);
  return at;
}

}  // namespace

StressLives::StressLives(const SnLaw& law, const ThinnedPosterior& points, const Stress& stress)
    : points_(points.weights.size()) {
  std::vector<PointLives> lives(points_);
  tbb::parallel_for(std::size_t{0}, points_, [&](std::size_t i) {
    lives[i] =
        lives_of_point(law, points.values.row(static_cast<Eigen::Index>(i)).data(), stress, i);
  });
  at_ = places_of(law, lives, points.weights);
  log_.resize(points_ * at_.size());
  for (std::size_t i = 0; i < points_; ++i) {
    if (!lives[i].defined) undefined_ += points.weights[i];
    endless_.push_back(lives[i].endless);
  }
  tbb::parallel_for(std::size_t{0}, points_, [&](std::size_t i) {
    double last = 0;
    for (std::size_t k = 0; k < at_.size(); ++k) {
      const double value = lives[i].defined ? log_survival_of(law, lives[i], at_[k]) : -infinity;
      log_[i * at_.size() + k] = last = std::min(last, value);
    }
  });
}

// Between grid points linear in the logarithm of survival.
double StressLives::log_survival_at(std::size_t point, double log10_life) const {
  const double* own = log_.data() + point * at_.size();
  const auto above = std::upper_bound(at_.begin(), at_.end(), log10_life);
  if (above == at_.begin()) return own[0] == -infinity ? -infinity : 0;
  if (above == at_.end()) return endless_[point] > 0 ? std::log(endless_[point]) : -infinity;
  const auto k = static_cast<std::size_t>(above - at_.begin());
  if (own[k] == -infinity) return own[k - 1] == -infinity ? -infinity : own[k - 1];
  const double part = (log10_life - at_[k - 1]) / (at_[k] - at_[k - 1]);
  return std::lerp(own[k - 1], own[k], part);
}

std::vector<double> StressLives::log_survival(double n, double known) const {
  std::vector<double> log(points_);
  for (std::size_t i = 0; i < points_; ++i) {
    const double all = n > 0 ? log_survival_at(i, std::log10(n)) : 0;
    const double before = known > 0 ? log_survival_at(i, std::log10(known)) : 0;
    log[i] = all == -infinity ? -infinity : std::min(0.0, all - before);
  }
  return log;
}

// The grid of remaining lives: close after n in steps of the remaining life, beyond that at the
// table's points.
std::vector<double> StressLives::places_beyond(double n) const {
  const double from = n > 0 ? std::log10(n) : -infinity;
  const auto first = std::upper_bound(at_.begin(), at_.end(), from);
  std::vector<double> places;
  if (n > 0 && first != at_.end()) {
    constexpr double least = 1e-5, ratio = 1.09;  // of n
    constexpr std::ptrdiff_t cells = 6;           // as long as even steps of log life are too wide
    const auto end = first + std::min(cells, at_.end() - first - 1);
    for (double r = least * n; std::log10(n + r) < *end; r *= ratio)
      places.push_back(std::log10(n + r));
    places.insert(places.end(), end, at_.end());
    return places;
  }
  places.assign(first, at_.end());
  return places;
}

prognosis::WeightedLives StressLives::remaining(std::span<const double> weight, double n) const {
  const double from = n > 0 ? std::log10(n) : -infinity;
  const std::vector<double> places = places_beyond(n);
  struct Between {
    std::size_t k;
    double part;
  };
  std::vector<Between> between;
  for (const double each : places) {
    const auto above = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(std::upper_bound(at_.begin(), at_.end(), each) - at_.begin(), 1,
                                   static_cast<std::ptrdiff_t>(at_.size()) - 1));
    between.push_back({above, (each - at_[above - 1]) / (at_[above] - at_[above - 1])});
  }
  std::vector<double> left(places.size(), 0.0);  // survivors at each point
  double all = 0;
  for (std::size_t i = 0; i < points_; ++i) {
    if (!(weight[i] > 0)) continue;
    const double now = n > 0 ? log_survival_at(i, from) : 0;
    if (now == -infinity) continue;
    all += weight[i];
    const double* own = log_.data() + i * at_.size();
    for (std::size_t p = 0; p < places.size(); ++p) {
      const auto [k, part] = between[p];
      // Before the first point hardly any life has ended.
      const double log = part <= 0             ? own[k - 1]
                         : part >= 1           ? own[k]
                         : own[k] == -infinity ? own[k - 1]
                                               : std::lerp(own[k - 1], own[k], part);
      left[p] += weight[i] * std::exp(std::min(0.0, log - now));
    }
  }
  std::vector<double> life, share;
  constexpr double light = 1e-13;
  double before = all, begin = n;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const double end = std::pow(10, places[p]);
    if (before - left[p] > light * all) {
      life.push_back((begin > 0 ? std::sqrt(begin * end) : 0.5 * end) - n);
      share.push_back(before - left[p]);
    }
    before = left[p];
    begin = end;
  }
  // Beyond the last point all lives are infinite.
  if (before > light * all) {
    life.push_back(infinity);
    share.push_back(before);
  }
  return {life, share};
}

}  // namespace wearwell::fatigue
