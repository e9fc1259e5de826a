#include "wearwell/models/fatigue/part_damage.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/life.h"
#include "wearwell/models/fatigue/limit_slices.h"
#include "wearwell/models/fatigue/stress_lives.h"
#include "wearwell/prognosis/weighted_quantiles.h"

namespace wearwell::fatigue {
namespace {

constexpr std::size_t used_cells = 16;              // of each item's scores
constexpr double golden_part = 0.6180339887498949;  // its multiples are the most even modulo 1

double tenth_power(double log10) {
  return std::exp(log10 * ln10);
}

// P(Z > z)
double upper_tail(StandardDistribution distribution, double z) {
  if (z == infinity) return 0;
  if (z == -infinity) return 1;
  return distribution == StandardDistribution::normal ? 0.5 * std::erfc(z * M_SQRT1_2)
                                                      : std::exp(-std::exp(z));
}

double part_of(double index, double irrational = golden_part) {
  double whole = 0;
  return std::modf((index + 0.5) * irrational, &whole);
}

}  // namespace

PartDamage::PartDamage(const SnLaw& law, const ThinnedPosterior& points, const LoadCycles& run,
                       const Stress& ahead, const DamageSum& sum)
    : law_(law), points_(points) {
  sum_median_ = std::log10(sum.median);
  sum_sd_ = std::log10(sum.factor);
  // The sum of two normal variables is normal.
  if (law.standard() == StandardDistribution::normal && !law.scatter_grows) widened_ = sum_sd_;
  double least_sigma = infinity;
  for (std::size_t i = 0; i < points.weights.size(); ++i) {
    add_point(points.values.row(static_cast<Eigen::Index>(i)).data(), i, run, ahead);
    for (std::size_t k = point_[i].first; k < point_[i].end; ++k)
      least_sigma = std::min(least_sigma, items_[k].sigma);
  }
  read_sums(sum, least_sigma);
  tbb::parallel_for(std::size_t{0}, point_.size(), [&](std::size_t i) {
    Point& point = point_[i];
    for (std::size_t k = point.first; point.defined && k < point.end; ++k)
      point.survival += items_[k].share * survivors(items_[k], 0);
  });
}

// The integral over log10 of the damage sum by the trapezoidal rule, whose error for a normal density
// falls exponentially with the number of nodes.
void PartDamage::read_sums(const DamageSum& sum, double least_sigma) {
  if (sum.factor == 1 || widened_ > 0) {
    sums_ = {{1, sum_median_}};
    return;
  }
  constexpr double reach = 6.5;
  const double step = 0.5 / std::clamp(sum_sd_ / least_sigma, 1.0, 16.0);
  const int count = static_cast<int>(std::ceil(reach / step));
  double all = 0;
  for (int k = -count; k <= count; ++k) {
    const double at = k * step, weight = std::exp(-0.5 * at * at);
    sums_.push_back({weight, sum_median_ + sum_sd_ * at});
    all += weight;
  }
  for (Sum& each : sums_) each.weight /= all;
}

// `lives`, `sigmas`: log10 of the curve's life under each stress, last under that ahead, and the
// scatter there; infinite where this part's limit is not reached.
void PartDamage::add_item(const double* x, double share, std::span<const double> lives,
                          std::span<const double> sigmas, std::span<const double> counts) {
  Item item;
  item.share = share;
  item.first = terms_.size();
  item.rate = lives.back() == infinity ? 0 : tenth_power(-lives.back());
  if (!law_.scatter_grows) {
    item.sigma = std::hypot(x[law_.sigma_index()], widened_);
    for (std::size_t j = 0; j < counts.size(); ++j)
      if (lives[j] != infinity) item.used += counts[j] * tenth_power(-lives[j]);
  } else {
    item.sigma = sigmas.back();
    for (std::size_t j = 0; j < counts.size(); ++j)
      if (lives[j] != infinity) terms_.push_back({std::log10(counts[j]) - lives[j], sigmas[j]});
  }
  item.end = terms_.size();
  items_.push_back(item);
}

void PartDamage::add_point(const double* x, std::size_t index, const LoadCycles& run,
                           const Stress& ahead) {
  std::vector<double> reversed, counts, lives, sigmas;
  for (const LoadCycle& each : run) {
    if (!(each.count > 0)) continue;
    reversed.push_back(law_.log10_reversed(x, each.stress));
    counts.push_back(each.count);
  }
  reversed.push_back(law_.log10_reversed(x, ahead));
  Point point{items_.size(), items_.size()};
  for (const double each : reversed) {
    lives.push_back(life_center(law_, x, each));
    sigmas.push_back(law_.sigma_at(x, lives.back()));
    point.defined &= !std::isnan(lives.back()) && sigmas.back() > 0;
  }
  if (!point.defined) {
    point_.push_back(point);
    return;
  }
  if (!law_.limit) {
    add_item(x, 1, lives, sigmas, counts);
  } else {
    for (const LimitSlice& slice : slices_of_limits(law_, x, reversed, index)) {
      if (!(slice.share > 0)) continue;
      std::vector<double> own = lives;
      for (std::size_t j = 0; j < own.size(); ++j)
        if (std::isfinite(reversed[j]))
          own[j] = law_.log10_life_of_item(x, reversed[j], slice.score);
      add_item(x, slice.share, own, sigmas, counts);
    }
  }
  point.end = items_.size();
  point_.push_back(point);
}

// The score of the part whose damage after so many further cycles is the sum; all above it survive.
double PartDamage::score(const Item& item, double further, double log10_sum) const {
  if (!law_.scatter_grows) {
    const double damage = item.used + further * item.rate;
    return damage > 0 ? (std::log10(damage) - log10_sum) / item.sigma : -infinity;
  }
  const bool ahead = further > 0 && item.rate > 0;
  const Term next{ahead ? std::log10(further * item.rate) : -infinity, item.sigma};
  double z = ahead ? (next.log10_damage - log10_sum) / next.sigma : -infinity;
  for (std::size_t j = item.first; j < item.end; ++j)
    z = std::max(z, (terms_[j].log10_damage - log10_sum) / terms_[j].sigma);
  if (!std::isfinite(z)) return z;
  // log D is convex and decreasing in z: from the left Newton's method does not overshoot.
  for (int i = 0; i < 50; ++i) {
    double sum = 0, slope = 0;
    const auto take = [&](const Term& term) {
      const double damage = tenth_power(term.log10_damage - term.sigma * z - log10_sum);
      sum += damage;
      slope += damage * term.sigma;
    };
    for (std::size_t j = item.first; j < item.end; ++j) take(terms_[j]);
    if (ahead) take(next);
    const double step = std::log10(sum) * sum / slope;
    z += step;
    if (!(std::abs(step) > 1e-12 * (1 + std::abs(z)))) break;
  }
  return z;
}

double PartDamage::survivors(const Item& item, double further) const {
  double sum = 0;
  for (const Sum& each : sums_)
    sum += each.weight * upper_tail(law_.standard(), score(item, further, each.log10));
  return sum;
}

// The remaining life of the part at score z.
double PartDamage::further_at(const Item& item, double z, double log10_sum) const {
  if (item.rate == 0) return infinity;
  double used = law_.scatter_grows ? 0 : item.used * tenth_power(-item.sigma * z);
  for (std::size_t j = item.first; j < item.end; ++j)
    used += tenth_power(terms_[j].log10_damage - terms_[j].sigma * z);
  return std::max(0.0, (tenth_power(log10_sum) - used) * tenth_power(item.sigma * z) / item.rate);
}

std::vector<double> PartDamage::log_survival() const {
  std::vector<double> log;
  log.reserve(point_.size());
  for (const Point& each : point_)
    log.push_back(each.survival > 0 ? std::min(0.0, std::log(each.survival)) : -infinity);
  return log;
}

// The weight of those that survive so many further cycles.
double PartDamage::left_after(std::span<const double> weight, double further) const {
  double sum = 0;
  for (std::size_t i = 0; i < point_.size(); ++i) {
    if (!(weight[i] > 0) || !(point_[i].survival > 0)) continue;
    double own = 0;
    for (std::size_t k = point_[i].first; k < point_[i].end; ++k)
      own += items_[k].share * survivors(items_[k], further);
    sum += weight[i] * own / point_[i].survival;
  }
  return sum;
}

// Remaining lives between which nearly all lie, in even steps of their logarithm.
std::vector<double> PartDamage::places(std::span<const double> weight) const {
  constexpr double light = 1e-7, tail = 1e-6, soon = 1e-4, least = 1e-12;
  double high = 0, sigma = infinity, all = 0;
  for (const double each : weight) all += each;
  const StandardDistribution scatter = law_.standard();
  const double widest = sum_median_ + (widened_ > 0 ? 0 : 4.5 * sum_sd_);
  for (std::size_t i = 0; i < point_.size(); ++i) {
    if (!(weight[i] > light * all) || !(point_[i].survival > 0)) continue;
    for (std::size_t k = point_[i].first; k < point_[i].end; ++k) {
      const Item& item = items_[k];
      const double left = survivors(item, 0);
      if (!(item.share * left > light * point_[i].survival) || item.rate == 0) continue;
      sigma = std::min(sigma, item.sigma);
      high = std::max(
          high, further_at(item, upper_quantile(scatter, std::max(left * tail, 1e-300)), widest));
    }
  }
  std::vector<double> at;
  if (!(high > 0)) return at;
  high = std::min(high, StressLives::most_cycles);
  const double now = left_after(weight, 0);
  double low = high;
  do low *= 0.25;
  while (low > least * high && now - left_after(weight, low) > soon * now);
  const double from = std::log10(low), until = std::log10(high);
  constexpr double widest_step = 0.02, finest_step = 0.004;
  const double step = std::clamp(0.1 * sigma, finest_step, widest_step);
  const auto count = static_cast<std::size_t>(std::ceil((until - from) / step));
  for (std::size_t k = 0; k <= count; ++k)
    at.push_back(
        tenth_power(std::lerp(from, until, static_cast<double>(k) / static_cast<double>(count))));
  return at;
}

// The weight of the survivors whose life has no end under the stress ahead.
double PartDamage::endless(std::span<const double> weight) const {
  double sum = 0;
  for (std::size_t i = 0; i < point_.size(); ++i) {
    if (!(weight[i] > 0) || !(point_[i].survival > 0)) continue;
    for (std::size_t k = point_[i].first; k < point_[i].end; ++k)
      if (items_[k].rate == 0)
        sum += weight[i] * items_[k].share * survivors(items_[k], 0) / point_[i].survival;
  }
  return sum;
}

prognosis::WeightedLives PartDamage::remaining(std::span<const double> weight) const {
  constexpr std::size_t blocks = 16;  // whatever the number of threads: the order of sums is fixed
  constexpr double light = 1e-13;
  const std::vector<double> at = places(weight);
  double all = 0;
  for (std::size_t i = 0; i < point_.size(); ++i)
    if (point_[i].survival > 0) all += weight[i];
  std::vector<std::vector<double>> sums(blocks, std::vector<double>(at.size(), 0.0));
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    const std::size_t n = point_.size();
    for (std::size_t i = b * n / blocks; i < (b + 1) * n / blocks; ++i) {
      const Point& point = point_[i];
      if (!(weight[i] > light * all) || !(point.survival > 0)) continue;
      for (std::size_t k = point.first; k < point.end; ++k) {
        const double own = weight[i] * items_[k].share / point.survival;
        if (!(own > light * all)) continue;
        for (std::size_t p = 0; p < at.size(); ++p) sums[b][p] += own * survivors(items_[k], at[p]);
      }
    }
  });
  std::vector<double> life, share;
  double before = all, begin = 0;
  for (std::size_t p = 0; p < at.size(); ++p) {
    double left = 0;
    for (std::size_t b = 0; b < blocks; ++b) left += sums[b][p];
    if (before - left > light * all) {
      life.push_back(begin > 0 ? std::sqrt(begin * at[p]) : 0.5 * at[p]);
      share.push_back(before - left);
    }
    before = left;
    begin = at[p];
  }
  // Beyond the last place are lives without end, and next to none of the others.
  const double beyond = !at.empty() && at.back() >= 0.999 * StressLives::most_cycles
                            ? before
                            : std::min(before, endless(weight));
  if (before - beyond > light * all) {
    life.push_back(at.empty() ? 0 : at.back());
    share.push_back(before - beyond);
  }
  if (beyond > light * all) {
    life.push_back(infinity);
    share.push_back(beyond);
  }
  return {life, share};
}

std::vector<std::vector<double>> PartDamage::used(std::span<const double> weight,
                                                  std::span<const double> further,
                                                  std::span<const double> levels) const {
  constexpr double light = 1e-9;
  // Parts at even places among the survivors of each item: damage so far and of one cycle ahead.
  std::vector<double> share, now, rate;
  const StandardDistribution scatter = law_.standard();
  for (std::size_t i = 0; i < point_.size(); ++i) {
    if (!(point_[i].survival > 0)) continue;
    const std::size_t items = point_[i].end - point_[i].first;
    const std::size_t cells =
        std::max<std::size_t>(2, used_cells / std::max<std::size_t>(items, 1));
    for (std::size_t k = point_[i].first; k < point_[i].end; ++k) {
      const Item& item = items_[k];
      const double own = weight[i] * item.share / point_[i].survival / static_cast<double>(cells);
      if (!(own > light * weight[i])) continue;
      for (std::size_t c = 0; c < cells; ++c) {
        const auto number = static_cast<double>(k * cells + c);
        double sum = sum_median_;
        if (widened_ == 0 && sum_sd_ > 0)
          sum += sum_sd_ * quantile(StandardDistribution::normal, part_of(number, M_SQRT2 - 1));
        const double left = upper_tail(scatter, score(item, 0, sum));
        if (!(own * left > 0)) continue;
        const double p =
            (static_cast<double>(c) + part_of(static_cast<double>(k))) / static_cast<double>(cells);
        const double z = upper_quantile(scatter, std::clamp(left * (1 - p), 1e-300, 1 - 1e-16));
        double damage = law_.scatter_grows ? 0 : item.used * tenth_power(-item.sigma * z);
        for (std::size_t j = item.first; j < item.end; ++j)
          damage += tenth_power(terms_[j].log10_damage - terms_[j].sigma * z);
        share.push_back(own * left);
        now.push_back(damage / tenth_power(sum));
        rate.push_back(item.rate * tenth_power(-item.sigma * z - sum));
      }
    }
  }
  std::vector<std::vector<double>> all;
  std::vector<double> level(share.size());
  for (const double each : further) {
    for (std::size_t j = 0; j < level.size(); ++j) level[j] = now[j] + each * rate[j];
    all.push_back(prognosis::weighted_quantiles(level, share, levels));
  }
  return all;
}

}  // namespace wearwell::fatigue
