#include "wearwell/plan/outcome_ranges.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/plan/row_densities.h"

namespace wearwell::plan {
namespace {

constexpr int grid_points = 41;
constexpr double negligible = 17;  // a log density so far below the highest does not count
constexpr int most_rounds = 9;

std::vector<double> even(double low, double high) {
  std::vector<double> t(grid_points);
  for (int i = 0; i < grid_points; ++i)
    t[static_cast<std::size_t>(i)] = low + (high - low) * i / (grid_points - 1);
  return t;
}

// What a grid shows of one test.
struct Found {
  double low = infinity, high = -infinity, narrowest = infinity, impossible = 0;
};

// Of one distribution on an even grid: the log densities by t.
void look(std::span<const double> t, std::span<const double> log_density, double weight,
          Found& found) {
  const auto peak = std::max_element(log_density.begin(), log_density.end());
  if (!(*peak > -infinity)) {
    found.impossible += weight;
    return;
  }
  const auto n = static_cast<std::ptrdiff_t>(t.size());
  const std::ptrdiff_t top = peak - log_density.begin();
  const double step = t[1] - t[0];
  std::ptrdiff_t first = top, last = top;
  while (first > 0 && log_density[static_cast<std::size_t>(first - 1)] > *peak - negligible)
    --first;
  while (last + 1 < n && log_density[static_cast<std::size_t>(last + 1)] > *peak - negligible)
    ++last;
  const std::ptrdiff_t middle = std::clamp(top, std::ptrdiff_t{1}, n - 2);
  const auto at = [&](std::ptrdiff_t i) { return log_density[static_cast<std::size_t>(i)]; };
  const double curvature = (at(middle - 1) - 2 * at(middle) + at(middle + 1)) / (step * step);
  const double sd = curvature < 0 && std::isfinite(curvature) ? std::sqrt(-1 / curvature) : step;
  found.narrowest = std::min(found.narrowest, sd);
  // At an end of the grid the peak lies beyond it: a normal distribution's where its slope says.
  double low = t[static_cast<std::size_t>(first)] - step;
  double high = t[static_cast<std::size_t>(last)] + step;
  if (top == 0) low -= 0.5 * (t.back() - t.front());
  if (top == n - 1) high += 0.5 * (t.back() - t.front());
  found.low = std::min(found.low, low);
  found.high = std::max(found.high, high);
}

struct Rows {
  std::vector<std::size_t> conditions;
  std::vector<TestOutcome> outcomes;
};

}  // namespace

double OutcomeScale::value(double t) const {
  return logarithmic ? std::exp(t) : t;
}
double OutcomeScale::place(double y) const {
  return logarithmic ? std::log(y) : y;
}

std::vector<OutcomeRange> outcome_ranges(const TestStudy& study, const Table& conditions,
                                         std::span<const PlannedTest> tests, const Points& scouts,
                                         std::span<const double> weights) {
  const OutcomeScale scale{study.positive};
  constexpr double widest = 23;  // ten decades
  const double middle = scale.place(study.typical);
  const double reach = study.positive ? widest : 30 * study.spread;
  std::vector<OutcomeRange> ranges(tests.size(), {middle - reach, middle + reach, reach, 0});
  std::vector<std::size_t> open(tests.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
  for (int round = 0; round < most_rounds && !open.empty(); ++round) {
    Rows rows;
    std::vector<std::vector<double>> grids;
    for (const std::size_t i : open) {
      grids.push_back(even(ranges[i].low, ranges[i].high));
      for (const double t : grids.back()) {
        rows.conditions.push_back(tests[i].row);
        rows.outcomes.push_back({scale.value(t), false});
      }
    }
    const Points log_density = row_densities(
        study, rows_with_outcomes(study, conditions, rows.conditions, rows.outcomes, "planned"),
        scouts, EffectIntegral::rough);
    std::vector<std::size_t> still;
    for (std::size_t k = 0; k < open.size(); ++k) {
      OutcomeRange& range = ranges[open[k]];
      Found found;
      std::vector<double> by_t(grid_points);
      for (Eigen::Index j = 0; j < scouts.rows(); ++j) {
        for (int p = 0; p < grid_points; ++p) {
          const auto q = static_cast<std::size_t>(p);
          by_t[q] = log_density(j, static_cast<Eigen::Index>(k * grid_points + q)) +
                    scale.log_slope(grids[k][q]);
        }
        look(grids[k], by_t, weights[static_cast<std::size_t>(j)], found);
      }
      range.impossible = found.impossible;
      if (!(found.low < found.high)) continue;  // impossible everywhere
      const double before = range.high - range.low, now = found.high - found.low;
      const bool moved = found.low < range.low || found.high > range.high;
      const bool steady =
          !moved && now > 0.6 * before && before < 30 * grid_points * found.narrowest;
      range.low = found.low, range.high = found.high, range.narrowest = found.narrowest;
      if (!steady) still.push_back(open[k]);
    }
    open = std::move(still);
  }
  return ranges;
}

}  // namespace wearwell::plan
