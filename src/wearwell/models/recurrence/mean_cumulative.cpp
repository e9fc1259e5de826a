#include "wearwell/models/recurrence/mean_cumulative.h"

#include <algorithm>
#include <cmath>

#include "wearwell/base/stop_scope.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell::recurrence {
namespace {

// A unit's failures less those expected of it, each over the number at risk, from step to step: their squares add up to the
// variance. Those of all units at risk move together, so that a step costs only its own events.
class Deviations {
 public:
  explicit Deviations(const std::vector<UnitHistory>& units) : units_(units), own_(units.size()) {
    for (std::size_t i = 0; i < units.size(); ++i) {
      by_start_.push_back(i);
      by_end_.push_back(i);
      for (const double age : units[i].failures) failures_.emplace_back(age, i);
    }
    std::sort(by_start_.begin(), by_start_.end(),
              [&](std::size_t a, std::size_t b) { return units[a].start < units[b].start; });
    std::sort(by_end_.begin(), by_end_.end(),
              [&](std::size_t a, std::size_t b) { return units[a].end < units[b].end; });
    std::sort(failures_.begin(), failures_.end());
  }

  // Goes to the next age of failures. Returns the sum of squares over all units.
  double step(double age, double at_risk) {
    for (; begun_ < by_start_.size() && units_[by_start_[begun_]].start < age; ++begun_) {
      own_[by_start_[begun_]] = expected_;
      ++count_;
    }
    for (; ended_ < by_end_.size() && units_[by_end_[ended_]].end < age; ++ended_) {
      const double last = own_[by_end_[ended_]] - expected_;
      of_ended_ += last * last;
      squares_ -= last * last;
      sum_ -= last;
      --count_;
    }
    std::size_t next = failure_;
    while (next < failures_.size() && failures_[next].first == age) ++next;
    const double more = static_cast<double>(next - failure_) / (at_risk * at_risk);
    expected_ += more;
    squares_ += more * (count_ * more - 2 * sum_);
    sum_ -= count_ * more;
    for (; failure_ < next; ++failure_) {
      double& own = own_[failures_[failure_].second];
      squares_ += (2 * (own - expected_) + 1 / at_risk) / at_risk;
      sum_ += 1 / at_risk;
      own += 1 / at_risk;
    }
    return std::max(0.0, of_ended_ + squares_);
  }

 private:
  const std::vector<UnitHistory>& units_;
  std::vector<double> own_;  // of each unit that has begun: its deviation plus `expected_`
  std::vector<std::size_t> by_start_, by_end_;
  std::vector<std::pair<double, std::size_t>> failures_;
  std::size_t begun_ = 0, ended_ = 0, failure_ = 0;
  double expected_ = 0;                       // of a unit from age 0 on
  double count_ = 0, sum_ = 0, squares_ = 0;  // of the deviations of units at risk
  double of_ended_ = 0;                       // squares of the others'
};

}  // namespace

std::vector<MeanCumulativeStep> mean_cumulative(const std::vector<UnitHistory>& units,
                                                double level) {
  std::vector<double> all, ages, starts, ends;
  for (const UnitHistory& unit : units) {
    all.insert(all.end(), unit.failures.begin(), unit.failures.end());
    starts.push_back(unit.start);
    ends.push_back(unit.end);
  }
  for (auto* each : {&all, &starts, &ends}) std::sort(each->begin(), each->end());
  ages = all;
  ages.erase(std::unique(ages.begin(), ages.end()), ages.end());
  const double z = upper_quantile(StandardDistribution::normal, 0.5 * (1 - level));
  std::vector<MeanCumulativeStep> steps;
  Deviations deviations(units);
  double mean = 0;
  for (const double age : ages) {
    check_stop();
    MeanCumulativeStep step;
    step.age = age;
    const auto [from, to] = std::equal_range(all.begin(), all.end(), age);
    step.failures = static_cast<std::size_t>(to - from);
    const auto begun = std::lower_bound(starts.begin(), starts.end(), age) - starts.begin();
    const auto ended = std::lower_bound(ends.begin(), ends.end(), age) - ends.begin();
    step.at_risk = static_cast<std::size_t>(begun - ended);
    const auto at_risk = static_cast<double>(step.at_risk);
    mean += static_cast<double>(step.failures) / at_risk;
    step.mean = mean;
    // Var = sum over units of the square of sum_k (d_i(t_k) - mean d(t_k))/at risk(t_k).
    step.se = deviations.step(age, at_risk);
    steps.push_back(step);
  }
  bool estimable = true;  // one unit alone shows no variance
  for (MeanCumulativeStep& step : steps) {
    estimable = estimable && step.at_risk > 1;
    step.se = estimable ? std::sqrt(step.se) : NAN;
    const double factor = std::exp(z * step.se / step.mean);
    step.low = step.mean / factor;
    step.high = step.mean * factor;
  }
  return steps;
}

std::vector<std::pair<double, double>> unobserved_ages(const std::vector<UnitHistory>& units) {
  std::vector<std::pair<double, double>> observed, gaps;
  for (const UnitHistory& unit : units) observed.emplace_back(unit.start, unit.end);
  std::sort(observed.begin(), observed.end());
  double until = observed.front().second;
  for (const auto& [start, end] : observed) {
    if (start > until) gaps.emplace_back(until, start);
    until = std::max(until, end);
  }
  return gaps;
}

}  // namespace wearwell::recurrence
