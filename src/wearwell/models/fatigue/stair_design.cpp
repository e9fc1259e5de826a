#include "wearwell/models/fatigue/stair_design.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

namespace wearwell::fatigue {
namespace {

constexpr double most_steps = 0.8;
constexpr std::size_t fewest_steps = 4;
constexpr std::size_t beyond = 8;    // levels at each end, for sequences that go farther
constexpr double same_level = 1e-9;  // of log10 of stress
constexpr double few = 20;           // tests that are simulated one by one

// A step in levels goes down after a failure and up after a survivor.
bool follows(int step, bool failed) {
  return failed ? step < 0 : step > 0;
}

double drawn_failures(double tests, double p, Rng& rng) {
  if (tests > few) {
    using boost::math::policies::discrete_quantile;
    using boost::math::policies::integer_round_up;
    using boost::math::policies::policy;
    const boost::math::binomial_distribution<double, policy<discrete_quantile<integer_round_up>>>
        binomial(tests, p);
    return quantile(binomial, rng.uniform());
  }
  double failures = 0;
  for (int i = 0; i < static_cast<int>(tests); ++i) failures += rng.uniform() < p ? 1 : 0;
  return failures;
}

}  // namespace

StairOutcomes StairDesign::simulate(StandardDistribution limit, double location, double scale,
                                    Rng& rng) const {
  StairOutcomes drawn = observed;
  const auto last = static_cast<int>(log10_stress.size()) - 1;
  for (std::size_t i = 0; i < drawn.level.size(); ++i) {
    const double p = cdf(limit, (log10_stress[drawn.level[i]] - location) / scale);
    drawn.failures[i] = drawn_failures(drawn.tests[i], std::clamp(p, 0.0, 1.0), rng);
    if (!up_and_down || i + 1 == drawn.level.size()) continue;
    int step = static_cast<int>(observed.level[i + 1]) - static_cast<int>(observed.level[i]);
    if (follows(step, observed.failures[i] > 0))
      step = drawn.failures[i] > 0 ? -std::abs(step) : std::abs(step);
    drawn.level[i + 1] =
        static_cast<std::size_t>(std::clamp(static_cast<int>(drawn.level[i]) + step, 0, last));
  }
  return drawn;
}

StairDesign stair_design(const std::vector<StairTest>& tests) {
  StairDesign design;
  std::vector<double>& levels = design.log10_stress;
  for (const StairTest& test : tests) levels.push_back(std::log10(test.stress));
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end(),
                           [](double a, double b) { return b - a < same_level; }),
               levels.end());
  bool single = true;
  for (const StairTest& test : tests) {
    const auto at =
        std::lower_bound(levels.begin(), levels.end(), std::log10(test.stress) - same_level);
    design.observed.level.push_back(static_cast<std::size_t>(at - levels.begin()));
    design.observed.tests.push_back(test.count);
    design.observed.failures.push_back(test.failed ? test.count : 0);
    single = single && test.count == 1;
  }
  const std::vector<std::size_t>& level = design.observed.level;
  std::size_t steps = 0;
  for (std::size_t i = 0; i + 1 < level.size(); ++i) {
    const int step = static_cast<int>(level[i + 1]) - static_cast<int>(level[i]);
    steps += follows(step, tests[i].failed) ? 1 : 0;
  }
  design.up_and_down =
      single && steps >= fewest_steps &&
      static_cast<double>(steps) >= most_steps * (static_cast<double>(level.size()) - 1);
  if (!design.up_and_down) {
    design.observed = by_level(design.observed, levels.size());
    return design;
  }
  const double low_step = levels[1] - levels[0], high_step = levels.back() - *(levels.end() - 2);
  for (std::size_t i = 0; i < beyond; ++i) {
    levels.insert(levels.begin(), levels.front() - low_step);
    levels.push_back(levels.back() + high_step);
  }
  for (std::size_t& each : design.observed.level) each += beyond;
  return design;
}

StairOutcomes by_level(const StairOutcomes& outcomes, std::size_t levels) {
  StairOutcomes sums;
  for (std::size_t l = 0; l < levels; ++l) sums.level.push_back(l);
  sums.tests.assign(levels, 0);
  sums.failures.assign(levels, 0);
  for (std::size_t i = 0; i < outcomes.level.size(); ++i) {
    sums.tests[outcomes.level[i]] += outcomes.tests[i];
    sums.failures[outcomes.level[i]] += outcomes.failures[i];
  }
  return sums;
}

}  // namespace wearwell::fatigue
