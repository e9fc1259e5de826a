#include "wearwell/models/fatigue/staircase.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/math/dual.h"

namespace wearwell::fatigue {
namespace {

class StaircaseLikelihood final : public LogDensity {
 public:
  StaircaseLikelihood(StandardDistribution limit, std::vector<StairTest> tests)
      : limit_(limit), tests_(std::move(tests)) {
    for (const StairTest& test : tests_) log10_stress_.push_back(std::log10(test.stress));
  }

  int dimension() const override { return 2; }
  double value(std::span<const double> x) const override { return formula(x.data()); }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<2>([this](const auto* p) { return formula(p); }, x,
                                           gradient);
  }
  std::vector<double> pointwise(std::span<const double> x) const override {
    std::vector<double> terms;
    for (std::size_t i = 0; i < tests_.size(); ++i) terms.push_back(term(x.data(), i));
    return terms;
  }
  std::vector<int> pointwise_counts() const override {
    std::vector<int> counts;
    for (const StairTest& test : tests_) counts.push_back(test.count);
    return counts;
  }

 private:
  template <class T>
  T term(const T* x, std::size_t i) const {
    const T w = (log10_stress_[i] - x[0]) / x[1];
    return tests_[i].failed ? log_cdf(limit_, w) : log_survival(limit_, w);
  }
  template <class T>
  T formula(const T* x) const {
    T sum(0);
    for (std::size_t i = 0; i < tests_.size(); ++i)
      sum += static_cast<double>(tests_[i].count) * term(x, i);
    return sum;
  }

  StandardDistribution limit_;
  std::vector<StairTest> tests_;
  std::vector<double> log10_stress_;
};

}  // namespace

std::shared_ptr<const LogDensity> staircase_likelihood(StandardDistribution limit,
                                                       std::vector<StairTest> tests) {
  return std::make_shared<StaircaseLikelihood>(limit, std::move(tests));
}

DixonMood dixon_mood(const std::vector<StairTest>& tests) {
  constexpr double equal = 0.01;  // of a step
  DixonMood result;
  std::vector<double> levels;
  double failures = 0, all = 0;
  for (const StairTest& test : tests) {
    levels.push_back(test.stress);
    all += test.count;
    failures += test.failed ? test.count : 0;
  }
  std::sort(levels.begin(), levels.end());
  double step = INFINITY;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double gap = levels[i] - levels[i - 1];
    if (gap > 1e-9 * levels[i]) step = std::min(step, gap);
  }
  if (std::isinf(step)) return {"it needs tests at two stresses"};
  for (const double level : levels) {
    const double steps = (level - levels.front()) / step;
    if (std::abs(steps - std::round(steps)) > equal)
      return {"the steps between stresses are not equal"};
  }
  if (failures == 0 || failures == all) return {"all tests ended alike"};
  result.step = step;
  result.of_failures = 2 * failures <= all;
  double lowest = INFINITY, n = 0, a = 0, b = 0;
  for (const StairTest& test : tests) {
    if (test.failed == result.of_failures) lowest = std::min(lowest, test.stress);
  }
  for (const StairTest& test : tests) {
    if (test.failed != result.of_failures) continue;
    const double i = std::round((test.stress - lowest) / step);
    n += test.count;
    a += test.count * i;
    b += test.count * i * i;
  }
  result.mean = lowest + step * (a / n + (result.of_failures ? -0.5 : 0.5));
  const double spread = (n * b - a * a) / (n * n);
  result.crude_sd = !(spread > 0.3);
  result.sd = result.crude_sd ? 0.53 * step : 1.62 * step * (spread + 0.029);
  return result;
}

}  // namespace wearwell::fatigue
