#include "wearwell/plan/count_outcomes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/math/constants.h"
#include "wearwell/plan/row_densities.h"

namespace wearwell::plan {
namespace {

using Eigen::Index;

constexpr int grid_counts = 41;
constexpr int rounds = 12;
constexpr double no_count = 17;   // a log probability so far below the highest does not count
constexpr double highest = 1e12;  // count
constexpr std::size_t most_values = 6000;

// The counts of a test: where they lie, and the least of sd / sqrt(1 + count) over the nodes, at most
// 1: that of a Poisson distribution is about 1 everywhere.
struct CountRange {
  double low = 0, high = highest, relative_sd = 1, impossible = 0;
  double allowed = highest;  // number of trials
};

double root(double count) {
  return std::sqrt(1 + count);
}

// Different whole numbers, even in the root of the count if they are many.
std::vector<double> spread_counts(const CountRange& range) {
  std::vector<double> counts;
  const double from = root(range.low), to = root(range.high);
  for (int i = 0; i < grid_counts; ++i) {
    const double t = from + (to - from) * i / (grid_counts - 1);
    const double count = std::clamp(std::round(t * t - 1), range.low, range.high);
    if (counts.empty() || count > counts.back()) counts.push_back(count);
  }
  return counts;
}

// What one distribution on a grid adds to the range of all.
void look_at_counts(std::span<const double> count, std::span<const double> log_p, double weight,
                    const CountRange& before, CountRange& found) {
  const auto peak = std::max_element(log_p.begin(), log_p.end());
  if (!(*peak > -infinity)) {
    found.impossible += weight;
    return;
  }
  const auto n = static_cast<std::ptrdiff_t>(count.size());
  const auto p = [&](std::ptrdiff_t i) { return log_p[static_cast<std::size_t>(i)]; };
  const auto at = [&](std::ptrdiff_t i) { return count[static_cast<std::size_t>(i)]; };
  const std::ptrdiff_t top = peak - log_p.begin();
  std::ptrdiff_t first = top, last = top;
  while (first > 0 && p(first - 1) > *peak - no_count) --first;
  while (last + 1 < n && p(last + 1) > *peak - no_count) ++last;
  double low = first > 0 ? at(first - 1) + 1 : before.low;
  double high = last + 1 < n ? at(last + 1) - 1 : before.high;
  const double reach = before.high - before.low + 1;
  if (first == 0) low = std::max(0.0, low - std::ceil(0.5 * reach));
  if (last + 1 == n) high = std::min(before.allowed, high + std::ceil(0.5 * reach));
  found.low = std::min(found.low, low);
  found.high = std::max(found.high, high);
  if (n < 3) return;
  // Curvature of log p at the peak, by divided differences.
  const std::ptrdiff_t middle = std::clamp(top, std::ptrdiff_t{1}, n - 2);
  const double left = (p(middle) - p(middle - 1)) / (at(middle) - at(middle - 1));
  const double right = (p(middle + 1) - p(middle)) / (at(middle + 1) - at(middle));
  const double curvature = 2 * (right - left) / (at(middle + 1) - at(middle - 1));
  if (curvature < 0 && std::isfinite(curvature))
    found.relative_sd = std::min(found.relative_sd, std::sqrt(-1 / curvature) / root(at(top)));
}

class CountTests {
 public:
  CountTests(const TestStudy& study, const Table& conditions, std::span<const PlannedTest> tests,
             const Points& nodes, std::span<const double> weights)
      : study_(study), conditions_(conditions), tests_(tests), nodes_(nodes), weights_(weights) {
    find_ranges(scouts_of(nodes, weights));
  }

  std::vector<Outcomes> outcomes() const {
    std::vector<Outcomes> all;
    std::vector<std::vector<double>> values;
    for (const CountRange& range : ranges_) all.push_back(blocks_of(range));
    for (const Outcomes& each : all) values.push_back(each.value);
    const Points log_p = densities(values, every_test(), nodes_, EffectIntegral::exact);
    Index first = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      Outcomes& each = all[i];
      const auto n = static_cast<Index>(each.value.size());
      each.log_probability.resize(nodes_.rows(), n);
      for (Index m = 0; m < n; ++m) {
        const auto k = static_cast<std::size_t>(m);
        const double log_size = std::log(each.cell_end[k] - each.cell_begin[k]);
        for (Index j = 0; j < nodes_.rows(); ++j)
          each.log_probability(j, m) = static_cast<float>(log_p(j, first + m) + log_size);
      }
      first += n;
      scale_to_one(each, weights_);
      refuse_unresolved(i, each);
    }
    return all;
  }

 private:
  std::vector<std::size_t> every_test() const {
    std::vector<std::size_t> all(tests_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
  }

  Points densities(const std::vector<std::vector<double>>& values,
                   const std::vector<std::size_t>& of_test, const Points& nodes,
                   EffectIntegral integral) const {
    std::vector<std::size_t> rows;
    std::vector<TestOutcome> cells;
    for (std::size_t k = 0; k < values.size(); ++k)
      for (const double value : values[k]) {
        rows.push_back(tests_[of_test[k]].row);
        cells.push_back({value, false});
      }
    return row_densities(study_,
                         rows_with_outcomes(study_, conditions_, rows, cells, "planned test"),
                         nodes, integral);
  }

  void find_ranges(const Scouts& scouts) {
    for (const PlannedTest& test : tests_) {
      CountRange range;
      if (!study_.trials.empty())
        range.allowed = cell_number(conditions_, conditions_.column(study_.trials), test.row);
      range.high = range.allowed;
      ranges_.push_back(range);
    }
    std::vector<std::size_t> open = every_test();
    for (int round = 0; round < rounds && !open.empty(); ++round) {
      std::vector<std::vector<double>> values;
      for (const std::size_t i : open) values.push_back(spread_counts(ranges_[i]));
      const Points log_p = densities(values, open, scouts.nodes, EffectIntegral::rough);
      std::vector<std::size_t> still;
      Index first = 0;
      for (std::size_t k = 0; k < open.size(); ++k) {
        if (!narrow(open[k], values[k], log_p, first, scouts)) still.push_back(open[k]);
        first += static_cast<Index>(values[k].size());
      }
      open = std::move(still);
    }
    for (std::size_t i = 0; i < tests_.size(); ++i)
      refuse_impossible(conditions_, tests_[i].row, ranges_[i].impossible);
  }

  // Whether the range is found.
  bool narrow(std::size_t test, const std::vector<double>& counts, const Points& log_p, Index first,
              const Scouts& scouts) {
    CountRange& range = ranges_[test];
    CountRange found{infinity, -infinity, 1, 0, range.allowed};
    std::vector<double> by_count(counts.size());
    for (Index j = 0; j < scouts.nodes.rows(); ++j) {
      for (std::size_t m = 0; m < counts.size(); ++m)
        by_count[m] = log_p(j, first + static_cast<Index>(m));
      look_at_counts(counts, by_count, scouts.weights[static_cast<std::size_t>(j)], range, found);
    }
    range.impossible = found.impossible;
    if (!(found.low <= found.high)) return true;  // impossible everywhere
    const bool same = found.low == range.low && found.high == range.high;
    const bool inside = found.low >= range.low && found.high <= range.high;
    const bool little = inside && found.high - found.low > 0.6 * (range.high - range.low);
    range.low = found.low, range.high = found.high;
    range.relative_sd = found.relative_sd;
    return same || little || (inside && found.high - found.low < grid_counts);
  }

  static Outcomes blocks_of(const CountRange& range) {
    Outcomes outcomes;
    outcomes.counted = true;
    constexpr double part = 0.5;  // of a standard deviation
    for (double begin = range.low; begin <= range.high && outcomes.value.size() <= most_values;) {
      const double wide = part * range.relative_sd * root(begin);
      const double half = std::floor(0.5 * std::max(0.0, wide - 1));
      const double size = std::min(2 * half + 1, range.allowed - begin + 1);
      const double middle = begin + std::floor(0.5 * (size - 1));
      outcomes.value.push_back(middle);
      outcomes.cell_begin.push_back(begin - 0.5);
      outcomes.cell_end.push_back(begin + size - 0.5);
      begin += size;
    }
    return outcomes;
  }

  void refuse_unresolved(std::size_t i, const Outcomes& outcomes) const {
    constexpr double most = 0.02;
    if (outcomes.defect <= most) return;
    throw InputError(fmt::format(
        "{}: {} of this test may be one of so many counts that the sum over them does not resolve "
        "its distribution (error {:.2g}); plan a smaller test",
        row_of(conditions_, tests_[i].row), study_.measured_name, outcomes.defect));
  }

  const TestStudy& study_;
  const Table& conditions_;
  std::span<const PlannedTest> tests_;
  const Points& nodes_;
  std::span<const double> weights_;
  std::vector<CountRange> ranges_;
};

}  // namespace

std::vector<Outcomes> count_outcomes(const TestStudy& study, const Table& conditions,
                                     std::span<const PlannedTest> tests, const Points& nodes,
                                     std::span<const double> weights) {
  return CountTests(study, conditions, tests, nodes, weights).outcomes();
}

}  // namespace wearwell::plan
