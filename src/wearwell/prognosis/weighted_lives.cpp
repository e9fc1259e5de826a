#include "wearwell/prognosis/weighted_lives.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/prognosis/float_order.h"

namespace wearwell::prognosis {
namespace {

struct Point {
  double life, weight;
};

// Sorts by the leading bits in which lives differ, two digits of twelve, and then by comparison
// within equal bits: comparisons took half of a monitor's time.
void sort(std::vector<Point>& points) {
  constexpr std::size_t few = 256;
  constexpr int digit = 12;
  constexpr std::size_t values = std::size_t{1} << digit;
  const auto less = [](const Point& a, const Point& b) { return a.life < b.life; };
  if (std::is_sorted(points.begin(), points.end(), less)) return;
  if (points.size() < few || points.size() > std::numeric_limits<std::uint32_t>::max())
    return std::stable_sort(points.begin(), points.end(), less);
  struct Key {
    std::uint32_t digits, place;
  };
  std::uint64_t least = ~std::uint64_t{0}, most = 0;
  for (const Point& each : points) {
    if (each.life == infinity) continue;  // so far off that all others would look alike
    const std::uint64_t order = order_of(each.life);
    least = std::min(least, order);
    most = std::max(most, order);
  }
  if (least > most) return;  // all infinite
  const int shift = std::max(0, static_cast<int>(std::bit_width(most - least)) - 2 * digit + 1);
  std::vector<Key> keys(points.size()), sorted(points.size());
  std::vector<std::uint32_t> low(values), high(values);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint64_t order = order_of(points[i].life);
    const auto digits =
        static_cast<std::uint32_t>(order > most ? values * values - 1 : (order - least) >> shift);
    keys[i] = {digits, static_cast<std::uint32_t>(i)};
    ++low[digits % values];
    ++high[digits / values];
  }
  std::exclusive_scan(low.begin(), low.end(), low.begin(), std::uint32_t{0});
  std::exclusive_scan(high.begin(), high.end(), high.begin(), std::uint32_t{0});
  for (const Key& each : keys) sorted[low[each.digits % values]++] = each;
  for (const Key& each : sorted) keys[high[each.digits / values]++] = each;
  std::vector<Point> in_order(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) in_order[i] = points[keys[i].place];
  for (std::size_t i = 0; i < keys.size();) {
    std::size_t end = i + 1;
    while (end < keys.size() && keys[end].digits == keys[i].digits) ++end;
    const auto at = [&](std::size_t k) {
      return in_order.begin() + static_cast<std::ptrdiff_t>(k);
    };
    if (end - i > 16) {
      std::stable_sort(at(i), at(end), less);
    } else {
      for (std::size_t k = i + 1; k < end; ++k)
        std::rotate(std::upper_bound(at(i), at(k), in_order[k], less), at(k), at(k + 1));
    }
    i = end;
  }
  points = std::move(in_order);
}

// Ends of cells of probability: 15 % longer from one to the next in the tails, where the cost of a
// rare failure is decided, and equal between.
std::vector<double> cell_ends() {
  constexpr double first = 1e-7, tail = 0.03, ratio = 1.15;
  constexpr int middle = 150;
  std::vector<double> lower = {0};
  for (double p = first; p < tail; p *= ratio) lower.push_back(p);
  std::vector<double> ends = lower;
  for (int i = 0; i <= middle; ++i) ends.push_back(tail + (1 - 2 * tail) * i / middle);
  for (auto each = lower.rbegin(); each != lower.rend(); ++each) ends.push_back(1 - *each);
  return ends;
}

}  // namespace

WeightedLives represented_lives(const std::function<double(double p)>& quantile) {
  static const std::vector<double> ends = cell_ends();
  std::vector<double> life, weight;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    life.push_back(quantile(0.5 * (ends[i - 1] + ends[i])));
    weight.push_back(ends[i] - ends[i - 1]);
  }
  return WeightedLives(life, weight);
}

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
  for (auto* each : {&life_, &weight_, &cumulated_}) each->resize(points.size());
  std::size_t count = 0;
  double before = 0;
  for (const auto& [place, all] : points) {
    const double share = all / sum;
    if (count > 0 && life_[count - 1] == place) {
      weight_[count - 1] += share;
      cumulated_[count - 1] += 0.5 * share;
    } else {
      life_[count] = place;
      weight_[count] = share;
      cumulated_[count] = before + 0.5 * share;
      ++count;
    }
    before += share;
  }
  for (auto* each : {&life_, &weight_, &cumulated_}) each->resize(count);
}

double WeightedLives::cdf(double x) const {
  const auto above = std::upper_bound(life_.begin(), life_.end(), x);
  if (above == life_.begin()) return 0;
  const auto i = static_cast<std::size_t>(above - life_.begin());
  const double done = cumulated_[i - 1] + 0.5 * weight_[i - 1];
  if (i == life_.size() || life_[i - 1] == infinity || life_[i] == infinity) return done;
  const double share = (x - life_[i - 1]) / (life_[i] - life_[i - 1]);
  const double between = cumulated_[i - 1] + share * (cumulated_[i] - cumulated_[i - 1]);
  // Lives of 0 have ended at once; they are not spread over a cell.
  return life_.front() == 0 ? std::max(weight_.front(), between) : between;
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
  check_stop();
  // The integral of the survival function: linear between points.
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
  check_stop();
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
  // Between two points both contribute partly; the whole point corrects the difference.
  const double before = 1 - cdf(x) - std::accumulate(weight.begin(), weight.end(), 0.0);
  if (before > 0) {
    life.insert(life.begin(), 0);
    weight.insert(weight.begin(), before);
  } else {
    weight.front() += before;
  }
  return WeightedLives(life, weight);
}

double relative_error(const WeightedLives& lives, double probability_error) {
  double largest = 0;
  if (lives.points().empty()) return largest;
  for (const double p : {0.05, 0.1, 0.5, 0.95}) {
    const double life = lives.quantile(p);
    if (!(life > 0) || !std::isfinite(life)) continue;
    for (const double off : {p - probability_error, p + probability_error}) {
      const double other = lives.quantile(off);
      if (std::isfinite(other)) largest = std::max(largest, std::abs(other / life - 1));
    }
  }
  return largest;
}

}  // namespace wearwell::prognosis
