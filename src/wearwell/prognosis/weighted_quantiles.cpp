#include "wearwell/prognosis/weighted_quantiles.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/prognosis/float_order.h"
#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::prognosis {
namespace {

constexpr std::size_t bins = 4096;

struct Point {
  double value, weight;
  std::size_t bin;
};

// The weights of values by the leading bits in which they differ.
struct Bins {
  static constexpr std::uint16_t none = bins;  // of values that do not count
  std::vector<double> weight = std::vector<double>(bins), before = std::vector<double>(bins);
  std::vector<std::uint16_t> of = {};  // by value
  double sum = 0;

  static bool counts(double value, double weight) { return weight > 0 && !std::isnan(value); }

  void fill(std::span<const double> values, std::span<const double> weights) {
    std::uint64_t least = ~std::uint64_t{0}, most = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!counts(values[i], weights[i]) || values[i] == infinity) continue;
      const std::uint64_t order = order_of(values[i]);
      least = std::min(least, order);
      most = std::max(most, order);
    }
    if (least > most) least = most = 0;
    // The last bin holds only infinite values.
    const int shift = std::max(0, static_cast<int>(std::bit_width(most - least)) - 11);
    std::fill(weight.begin(), weight.end(), 0);
    of.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      of[i] = none;
      if (!counts(values[i], weights[i])) continue;
      const std::uint64_t order = order_of(values[i]);
      of[i] = static_cast<std::uint16_t>(order > most ? bins - 1 : (order - least) >> shift);
      weight[of[i]] += weights[i];
    }
    sum = 0;
    for (std::size_t b = 0; b < bins; ++b) {
      before[b] = sum;
      sum += weight[b];
    }
  }

  // The bin of a quantile, and its nonempty neighbours.
  struct Range {
    std::size_t first, last;
  };
  Range about(double target) const {
    const auto above = std::upper_bound(before.begin(), before.end(), target);
    auto b = static_cast<std::size_t>(above - before.begin()) - 1;
    while (b > 0 && !(weight[b] > 0)) --b;
    Range range{b, b};
    for (std::size_t k = b; k-- > 0 && range.first == b;) {
      if (weight[k] > 0) range.first = k;
    }
    for (std::size_t k = b + 1; k < bins && range.last == b; ++k) {
      if (weight[k] > 0) range.last = k;
    }
    return range;
  }
};

// As WeightedLives::quantile, for sorted points after an earlier weight of `before`.
double quantile_of(std::span<const Point> points, double before, double target) {
  double last = std::nan(""), last_middle = 0, last_weight = 0;
  for (std::size_t i = 0; i < points.size();) {
    double weight = 0;
    const double value = points[i].value;
    for (; i < points.size() && points[i].value == value; ++i) weight += points[i].weight;
    const double middle = before + 0.5 * weight;
    if (middle > target) {
      if (std::isnan(last)) return value;
      if (value == infinity) return target < last_middle + 0.5 * last_weight ? last : infinity;
      return last + (target - last_middle) / (middle - last_middle) * (value - last);
    }
    before += weight;
    last = value;
    last_middle = middle;
    last_weight = weight;
  }
  return last;
}

}  // namespace

std::vector<double> weighted_quantiles(std::span<const double> value,
                                       std::span<const double> weight, std::span<const double> at) {
  static thread_local Bins all;  // one for each thread: its memory costs as much as the rest
  all.fill(value, weight);
  std::vector<double> quantiles(at.size(), std::nan(""));
  if (!(all.sum > 0)) return quantiles;
  std::vector<std::uint8_t> wanted(bins + 1);
  std::vector<Bins::Range> ranges;
  for (const double p : at) {
    ranges.push_back(all.about(p * all.sum));
    std::fill(wanted.begin() + static_cast<std::ptrdiff_t>(ranges.back().first),
              wanted.begin() + static_cast<std::ptrdiff_t>(ranges.back().last) + 1, 1);
  }
  std::vector<Point> points;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (wanted[all.of[i]]) points.push_back({value[i], weight[i], all.of[i]});
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const Point& a, const Point& b) { return a.value < b.value; });
  for (std::size_t k = 0; k < at.size(); ++k) {
    const auto in_bin = [](const Point& point, std::size_t bin) { return point.bin < bin; };
    const auto first = std::lower_bound(points.begin(), points.end(), ranges[k].first, in_bin);
    const auto last = std::lower_bound(first, points.end(), ranges[k].last + 1, in_bin);
    quantiles[k] = quantile_of({first, last}, all.before[ranges[k].first], at[k] * all.sum);
  }
  return quantiles;
}

}  // namespace wearwell::prognosis
