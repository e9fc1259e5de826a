#include "wearwell/models/recurrence/mean_cumulative.h"

#include <algorithm>
#include <cmath>

#include "wearwell/prob/standard_distribution.h"

namespace wearwell::recurrence {
namespace {

// Sums over the steps at which a unit is at risk, as differences of running sums.
class RunningSum {
 public:
  explicit RunningSum(const std::vector<double>& ages) : ages_(ages) {}
  void add(double value) { sums_.push_back(sums_.back() + value); }
  // Over the ages in (start, end] up to step k.
  double between(double start, double end, std::size_t k) const {
    const std::size_t begin = position(start), until = std::min(position(end), k + 1);
    return until > begin ? sums_[until] - sums_[begin] : 0;
  }

 private:
  std::size_t position(double age) const {
    return static_cast<std::size_t>(std::upper_bound(ages_.begin(), ages_.end(), age) -
                                    ages_.begin());
  }
  const std::vector<double>& ages_;
  std::vector<double> sums_ = {0};
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
  RunningSum increments(
      ages);  // of the share of failures among the units at risk, over those at risk
  double mean = 0;
  for (const double age : ages) {
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
    increments.add(static_cast<double>(step.failures) / (at_risk * at_risk));
    steps.push_back(step);
  }
  // Var = sum over units of the square of sum_k (d_i(t_k) - mean d(t_k))/at risk(t_k).
  for (const UnitHistory& unit : units) {
    double own = 0;
    std::size_t next = 0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      for (; next < unit.failures.size() && unit.failures[next] == steps[k].age; ++next)
        own += 1 / static_cast<double>(steps[k].at_risk);
      const double deviation = own - increments.between(unit.start, unit.end, k);
      steps[k].se += deviation * deviation;
    }
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

}  // namespace wearwell::recurrence
