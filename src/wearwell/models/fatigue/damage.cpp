#include "wearwell/models/fatigue/damage.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/math/constants.h"

namespace wearwell::fatigue {
namespace {

// For crack growth, mean over steels (Liu and Zenner).
constexpr double crack_slope = 3.6;

double power(double log10) {
  return std::exp(log10 * ln10);
}

}  // namespace

BlockDamage::BlockDamage(const SnLaw& law, const double* x, const DamageRule& rule,
                         const LoadCycles& cycles)
    : law_(law), x_(x), rule_(rule), slope_(-1 / x[1]) {
  given_.reserve(cycles.size());
  for (const LoadCycle& cycle : cycles) given_.push_back(law.log10_reversed(x, cycle.stress));
  std::vector<std::size_t> order(cycles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!std::is_sorted(given_.begin(), given_.end(), std::greater<>()))
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return given_[a] > given_[b]; });
  for (const std::size_t i : order) {
    if (given_[i] == -infinity || cycles[i].count == 0) continue;
    fatal_ = fatal_ || !(given_[i] < infinity);
    log10_reversed_.push_back(given_[i]);
    count_.push_back(cycles[i].count);
  }
  if (fatal_ || log10_reversed_.empty()) return;
  if (!law.straight()) {
    if (!law.integrated()) add_lives();
    return;
  }
  top_ = log10_reversed_.front();
  // Sums of count (S/largest)^slope: by the slope above the knee, and by the slope below it.
  below_slope_ = rule.miner == MinerRule::haibach ? 2 * slope_ - 1 : slope_;
  if (rule.miner == MinerRule::liu_zenner) slope_ = 0.5 * (slope_ + crack_slope);
  const auto running = [&](double slope) {
    std::vector<double> sums = {0};
    for (std::size_t i = 0; i < count_.size(); ++i)
      sums.push_back(sums.back() + count_[i] * power(slope * (log10_reversed_[i] - top_)));
    return sums;
  };
  above_ = running(slope_);
  if (rule.miner == MinerRule::haibach) below_ = running(below_slope_);
}

// For a curved S-N line: each stress's own life, and sums of damage from the largest down.
void BlockDamage::add_lives() {
  above_ = {0};
  for (std::size_t i = 0; i < count_.size(); ++i) {
    life_.push_back(law_.log10_life(x_, log10_reversed_[i]));
    above_.push_back(above_.back() + count_[i] * power(life_.front() - life_[i]));
  }
}

// To an item at quantile score z of the scatter, by the cycles above a limit.
double BlockDamage::log10_damage_of_lives(double z, double limit) const {
  std::size_t n = life_.size();
  if (law_.limit) {
    const double* x = x_ + law_.limit_index();
    const double least = x[0] + x[1] * limit;
    n = static_cast<std::size_t>(std::partition_point(log10_reversed_.begin(),
                                                      log10_reversed_.end(),
                                                      [&](double s) { return s > least; }) -
                                 log10_reversed_.begin());
  }
  if (n == 0 || life_.front() == infinity) return -infinity;
  if (!law_.scatter_grows)
    return std::log10(above_[n]) - life_.front() - x_[law_.sigma_index()] * z;
  double sum = 0;
  const double first = life_.front() + law_.sigma_at(x_, life_.front()) * z;
  for (std::size_t i = 0; i < n && life_[i] < infinity; ++i)
    sum += count_[i] * power(first - life_[i] - law_.sigma_at(x_, life_[i]) * z);
  return std::log10(sum) - first;
}

// log10 of the knee's stress for an item at quantile score z; -infinity without one.
double BlockDamage::knee(double z) const {
  if (!rule_.knee.any() || rule_.miner == MinerRule::elementary) return -infinity;
  const double at =
      rule_.knee.stress
          ? std::log10(*rule_.knee.stress)
          : x_[0] + x_[1] * (std::log10(*rule_.knee.life) - x_[law_.sigma_index()] * z);
  return rule_.miner == MinerRule::liu_zenner ? at - std::log10(2.0) : at;
}

double BlockDamage::log10_damage(double z, double limit) const {
  if (fatal_) return infinity;
  if (log10_reversed_.empty()) return -infinity;
  if (!law_.straight() && !law_.integrated()) return log10_damage_of_lives(z, limit);
  const double scatter = x_[law_.sigma_index()] * z;
  if (law_.limit) {
    double sum = 0, first = infinity;
    for (std::size_t i = 0; i < count_.size(); ++i) {
      const double life = law_.log10_life_of_item(x_, log10_reversed_[i], limit);
      if (life == infinity) break;  // and all smaller ones
      if (first == infinity) first = life;
      sum += count_[i] * power(first - life);
    }
    return sum > 0 ? std::log10(sum) - first - scatter : -infinity;
  }
  const double life_at_top = law_.log10_life(x_, top_) + scatter;
  const double knee_at = knee(z);
  // The first stress below the knee.
  const auto below =
      static_cast<std::size_t>(std::partition_point(log10_reversed_.begin(), log10_reversed_.end(),
                                                    [&](double s) { return s >= knee_at; }) -
                               log10_reversed_.begin());
  double sum = above_[below];
  if (rule_.miner == MinerRule::haibach && below < count_.size()) {
    // The two lines meet at the knee.
    const double ratio = power((slope_ - below_slope_) * (knee_at - top_));
    sum += ratio * (below_.back() - below_[below]);
  }
  return sum > 0 ? std::log10(sum) - life_at_top : -infinity;
}

double BlockDamage::log10_damage_of_one(double at, double knee_at) const {
  if (at == infinity) return 0;
  if (at == -infinity || fatal_) return -infinity;
  if (law_.limit) return -law_.log10_life_of_item(x_, at, 0);
  if (!law_.straight()) return -law_.log10_life(x_, at);
  const double at_top = -law_.log10_life(x_, top_);
  if (at >= knee_at) return at_top + slope_ * (at - top_);
  if (rule_.miner != MinerRule::haibach) return -infinity;
  return at_top + slope_ * (knee_at - top_) + below_slope_ * (at - knee_at);
}

std::vector<double> BlockDamage::shares(const LoadCycles& cycles) const {
  const double knee_at = law_.straight() ? knee(0) : -infinity;
  std::vector<double> shares;
  double largest = -infinity, sum = 0;
  for (const double at : given_) {
    shares.push_back(log10_damage_of_one(at, knee_at));
    largest = std::max(largest, shares.back());
  }
  for (std::size_t i = 0; i < shares.size(); ++i) {
    shares[i] = largest > -infinity ? cycles[i].count * power(shares[i] - largest) : 0;
    sum += shares[i];
  }
  for (double& each : shares) each = sum > 0 ? each / sum : 0;
  return shares;
}

}  // namespace wearwell::fatigue
