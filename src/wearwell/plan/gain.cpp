#include "wearwell/plan/gain.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/rng.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"

namespace wearwell::plan {
namespace {

using Eigen::Index;

// The value at which the cumulated weight, half of each node's below it, reaches `share`.
double quantile_between(std::span<const double> goal, std::span<const double> weight, double sum,
                        double share) {
  const double wanted = share * sum;
  double below = 0, before = 0, at_before = goal.front();
  bool first = true;
  for (std::size_t j = 0; j < goal.size(); ++j) {
    if (!(weight[j] > 0)) continue;
    const double at = below + 0.5 * weight[j];
    if (at >= wanted) {
      if (first) return goal[j];
      return std::lerp(at_before, goal[j], (wanted - before) / (at - before));
    }
    before = at, at_before = goal[j], first = false;
    below += weight[j];
  }
  return at_before;
}

// What the best decision under these weights saves against today's, times the sum of the weights.
double saved_by(const GoalNodes& nodes, const std::vector<double>& weight) {
  if (nodes.loss.size() == 0) return 0;
  const Eigen::Map<const Eigen::VectorXd> w(weight.data(), std::ssize(weight));
  const Eigen::RowVectorXd loss = w.transpose() * nodes.loss;
  return loss[nodes.best] - loss.minCoeff();
}

// Tests of a batch, specimen by specimen.
std::vector<const Outcomes*> specimens_of(const Batch& batch) {
  std::vector<const Outcomes*> all;
  for (std::size_t k = 0; k < batch.outcomes.size(); ++k)
    all.insert(all.end(), static_cast<std::size_t>(batch.specimens[k]), batch.outcomes[k]);
  return all;
}

// One simulated result of all tests.
struct Simulated {
  std::vector<double> weight;                   // of the nodes afterwards, relative
  double log_evidence = 0, log_likelihood = 0;  // of the outcomes; and under the node drawn
  double use = 0, runouts = 0;
};

class Nested {
 public:
  Nested(const GoalNodes& nodes, const Batch& batch, const NestedSettings& settings)
      : nodes_(nodes), settings_(settings), tests_(specimens_of(batch)) {
    cumulated_.resize(nodes.weight.size());
    std::partial_sum(nodes.weight.begin(), nodes.weight.end(), cumulated_.begin());
  }

  Simulated sample(int s) const {
    check_stop();
    const std::size_t n = nodes_.weight.size();
    const double share = (s + 0.5) / settings_.samples * cumulated_.back();
    const auto at = std::upper_bound(cumulated_.begin(), cumulated_.end(), share);
    const auto node = static_cast<Index>(
        std::min<std::ptrdiff_t>(at - cumulated_.begin(), static_cast<std::ptrdiff_t>(n) - 1));
    Simulated found;
    std::vector<double> log_weight(n, 0.0);
    Rng rng(settings_.seed, static_cast<std::uint64_t>(s));
    for (const Outcomes* test : tests_) {
      const std::size_t m = test->drawn_index(node, rng.uniform());
      const auto column = test->log_probability.col(static_cast<Index>(m));
      for (std::size_t j = 0; j < n; ++j)
        log_weight[j] += static_cast<double>(column[static_cast<Index>(j)]);
      found.use += test->value[m];
      found.runouts += test->runout && m + 1 == test->size() ? 1 : 0;
    }
    found.log_likelihood = log_weight[static_cast<std::size_t>(node)];
    const double highest = *std::max_element(log_weight.begin(), log_weight.end());
    found.weight.resize(n);
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      found.weight[j] = nodes_.weight[j] * std::exp(log_weight[j] - highest);
      sum += found.weight[j];
    }
    found.log_evidence = highest + std::log(sum / cumulated_.back());
    return found;
  }

  std::size_t tests() const { return tests_.size(); }

 private:
  const GoalNodes& nodes_;
  const NestedSettings& settings_;
  std::vector<const Outcomes*> tests_;
  std::vector<double> cumulated_;
};

// Mean and its standard error. Samples of neighbouring strata differ little in the node, so half
// of the squared differences of neighbours estimates the variance within strata.
struct Average {
  double mean = 0, error = 0;
};
Average average(std::span<const double> values) {
  Average found;
  const auto n = static_cast<double>(values.size());
  for (const double each : values) found.mean += each / n;
  double squares = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    squares += (values[i] - values[i - 1]) * (values[i] - values[i - 1]);
  if (values.size() > 1) found.error = std::sqrt(squares / (2 * (n - 1)) / n);
  return found;
}

}  // namespace

double effective_number(std::span<const double> weight) {
  double sum = 0, squares = 0;
  for (const double each : weight) sum += each, squares += each * each;
  return squares > 0 ? sum * sum / squares : 0;
}

GoalSpread goal_spread(std::span<const double> goal, std::span<const double> weight) {
  GoalSpread spread;
  double sum = 0, mean = 0, squares = 0;
  for (std::size_t j = 0; j < goal.size(); ++j) {
    sum += weight[j];
    mean += weight[j] * goal[j];
  }
  mean /= sum;
  for (std::size_t j = 0; j < goal.size(); ++j)
    squares += weight[j] * (goal[j] - mean) * (goal[j] - mean);
  spread.mean = mean;
  spread.sd = std::sqrt(squares / sum);
  spread.low = quantile_between(goal, weight, sum, 0.05);
  spread.median = quantile_between(goal, weight, sum, 0.5);
  spread.high = quantile_between(goal, weight, sum, 0.95);
  return spread;
}

Gain gain_of_one(const GoalNodes& nodes, const Outcomes& outcomes) {
  const std::size_t n = nodes.goal.size();
  Gain gain;
  std::vector<double> weight(n);
  for (std::size_t m = 0; m < outcomes.size(); ++m) {
    check_stop();
    const auto column = outcomes.log_probability.col(static_cast<Index>(m));
    double evidence = 0, log_sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const auto log_p = static_cast<double>(column[static_cast<Index>(j)]);
      weight[j] = nodes.weight[j] * std::exp(log_p);
      evidence += weight[j];
      if (weight[j] > 0) log_sum += weight[j] * log_p;
    }
    constexpr double least = 1e-12;
    if (!(evidence > least)) continue;
    const GoalSpread after = goal_spread(nodes.goal, weight);
    gain.variance += evidence * after.sd * after.sd;
    gain.width += evidence * after.width();
    gain.information += log_sum - evidence * std::log(evidence);
    gain.use += evidence * outcomes.value[m];
    if (outcomes.runout && m + 1 == outcomes.size()) gain.runout = evidence;
    gain.effective += evidence * effective_number(weight);
    gain.saved += saved_by(nodes, weight);
  }
  gain.information = std::max(0.0, gain.information);
  return gain;
}

Gain gain_of_batch(const GoalNodes& nodes, const Batch& batch, const NestedSettings& settings) {
  const Nested nested(nodes, batch, settings);
  const auto n = static_cast<std::size_t>(settings.samples);
  std::vector<double> variance(n), width(n), information(n), use(n), runouts(n), effective(n),
      saved(n);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t s) {
    const Simulated each = nested.sample(static_cast<int>(s));
    const GoalSpread after = goal_spread(nodes.goal, each.weight);
    variance[s] = after.sd * after.sd;
    width[s] = after.width();
    information[s] = each.log_likelihood - each.log_evidence;
    use[s] = each.use;
    runouts[s] = each.runouts;
    effective[s] = effective_number(each.weight);
    saved[s] =
        saved_by(nodes, each.weight) / std::accumulate(each.weight.begin(), each.weight.end(), 0.0);
  });
  const Average of_variance = average(variance), of_width = average(width),
                of_information = average(information), of_saved = average(saved);
  const auto tests = static_cast<double>(std::max<std::size_t>(1, nested.tests()));
  return {of_variance.mean,
          of_variance.error,
          of_width.mean,
          of_width.error,
          of_information.mean,
          of_information.error,
          average(use).mean / tests,
          average(runouts).mean / tests,
          average(effective).mean,
          of_saved.mean,
          of_saved.error};
}

std::vector<double> typical_posterior(const GoalNodes& nodes, const Batch& batch,
                                      const NestedSettings& settings, double sd) {
  const Nested nested(nodes, batch, settings);
  const double median = goal_spread(nodes.goal, nodes.weight).median;
  std::vector<double> best;
  double least = infinity;
  for (int s = 0; s < settings.samples; ++s) {
    Simulated each = nested.sample(s);
    const GoalSpread after = goal_spread(nodes.goal, each.weight);
    const double off = std::abs(after.sd / sd - 1) + std::abs(after.median - median) / sd;
    if (!(off < least)) continue;
    least = off;
    best = std::move(each.weight);
  }
  const double sum = std::accumulate(best.begin(), best.end(), 0.0);
  for (double& each : best) each /= sum;
  return best;
}

}  // namespace wearwell::plan
