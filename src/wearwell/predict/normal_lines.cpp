#include "wearwell/predict/normal_lines.h"

#include <algorithm>
#include <cmath>

#include "wearwell/base/stop_scope.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/root.h"

namespace wearwell {
namespace {

constexpr std::size_t neighbours = 6;

bool is_monotone(std::span<const double> value) {
  const bool rising = value.front() <= value.back();
  for (std::size_t i = 1; i < value.size(); ++i)
    if (rising ? value[i] < value[i - 1] : value[i] > value[i - 1]) return false;
  return true;
}

}  // namespace

void NormalLines::add(double weight, double first, double step, std::span<const double> value) {
  if (!(weight > 0) || value.empty()) return;
  for (const double each : value) {
    if (std::isnan(each)) defined_ = false;
    if (!std::isfinite(each)) continue;
    low_ = std::min(low_, each);
    high_ = std::max(high_, each);
  }
  const std::size_t begin = values_.size();
  values_.insert(values_.end(), value.begin(), value.end());
  lines_.push_back({weight, first, step, begin, values_.size(), is_monotone(value)});
  weight_ += weight;
}

// The score between nodes i and i + 1 of a line, whose values have x between them.
double NormalLines::score_at(const Line& line, std::size_t i, double x) const {
  const double* y = values_.data() + line.begin;
  const std::size_t n = line.end - line.begin;
  const double score = line.first + line.step * static_cast<double>(i);
  if (!std::isfinite(y[i]) || !std::isfinite(y[i + 1])) {
    // There the quantity diverges like 1/(distance from some score).
    const bool up = std::isfinite(y[i]);
    const double end = up ? y[i] : y[i + 1];
    const double part = std::isfinite(end) && x > 0 && end > 0 ? 1 - end / x : 0.5;
    return score + line.step * (up ? part : 1 - part);
  }
  // Neighbouring finite nodes.
  std::size_t first = i, last = i + 1;
  while (last - first + 1 < neighbours) {
    const bool before = first > 0 && std::isfinite(y[first - 1]),
               behind = last + 1 < n && std::isfinite(y[last + 1]);
    if (!before && !behind) break;
    if (before && (!behind || i - first <= last - i - 1))
      --first;
    else
      ++last;
  }
  const std::size_t count = last - first + 1;
  // Uses logarithms of lives, which are smoother.
  const bool positive = *std::min_element(y + first, y + last + 1) > 0;
  const auto scaled = [positive](double value) { return positive ? std::log(value) : value; };
  double value[neighbours];
  for (std::size_t k = 0; k < count; ++k) value[k] = scaled(y[first + k]);
  const double at = scaled(x), sign = y[i + 1] > y[i] ? 1 : -1;
  const auto beyond = [&](double u) {  // Neville's scheme, u in steps from node i
    double p[neighbours] = {};
    std::copy_n(value, count, p);
    for (std::size_t level = 1; level < count; ++level) {
      for (std::size_t k = 0; k + level < count; ++k) {
        const double from = static_cast<double>(first + k) - static_cast<double>(i);
        const auto length = static_cast<double>(level);
        p[k] = ((from + length - u) * p[k] + (u - from) * p[k + 1]) / length;
      }
    }
    return sign * (p[0] - at);
  };
  const double u = solve_increasing(beyond, 0.5, 0.5, {.absolute = 1e-10}, 0, 1);
  return score + line.step * u;
}

// The fraction of a line's items up to x.
double NormalLines::below(const Line& line, double x) const {
  const double* y = values_.data() + line.begin;
  const std::size_t n = line.end - line.begin;
  if (n == 1) return y[0] <= x ? 1 : 0;
  if (line.monotone) {
    const bool rising = y[0] <= y[n - 1];
    const auto* found = rising ? std::upper_bound(y, y + n, x)
                               : std::partition_point(y, y + n, [x](double v) { return v > x; });
    const auto k =
        static_cast<std::size_t>(found - y);  // the first beyond x (decreasing: the first up to x)
    if (k == 0 || k == n) return rising == (k == n) ? 1 : 0;
    const double below = normal_cdf(score_at(line, k - 1, x));
    return rising ? below : 1 - below;
  }
  double sum = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double left = line.first + line.step * static_cast<double>(i);
    double from = i == 0 ? -infinity : left, to = i + 2 == n ? infinity : left + line.step;
    const bool a = y[i] <= x, b = y[i + 1] <= x;
    if (!a && !b) continue;
    if (a != b) (a ? to : from) = score_at(line, i, x);
    sum += normal_cdf(to) - normal_cdf(from);
  }
  return sum;
}

double NormalLines::cdf(double x) const {
  check_stop();
  if (!defined_ || lines_.empty()) return std::nan("");
  double sum = 0;
  for (const Line& line : lines_) sum += line.weight * below(line, x);
  return sum / weight_;
}

double NormalLines::quantile(double p) const {
  if (!defined_ || lines_.empty()) return std::nan("");
  if (!(low_ <= high_) || cdf(high_) < p) return infinity;
  if (!(low_ < high_) || cdf(low_) >= p) return low_;
  // Starts at the quantile of the line with the largest weight.
  const Line& line =
      *std::max_element(lines_.begin(), lines_.end(),
                        [](const Line& a, const Line& b) { return a.weight < b.weight; });
  const std::span<const double> y(values_.data() + line.begin, line.end - line.begin);
  const double upwards = normal_score(std::log(p), std::log1p(-p));
  const double score = y.front() <= y.back() ? upwards : -upwards;
  const auto last = static_cast<double>(y.size() - 1);
  const auto i =
      static_cast<std::size_t>(std::clamp(std::round((score - line.first) / line.step), 0.0, last));
  const double guess = std::isfinite(y[i]) ? y[i] : 0.5 * low_ + 0.5 * high_;
  const double near = y[i > 0 ? i - 1 : std::min<std::size_t>(1, y.size() - 1)];
  double step = std::max(std::abs(near - guess), 1e-6 * std::abs(guess));
  if (!(step > 0) || !std::isfinite(step)) step = 0.25 * (high_ - low_);
  return solve_increasing([&](double x) { return cdf(x) - p; }, guess, step, {.relative = 1e-8},
                          low_, high_);
}

}  // namespace wearwell
