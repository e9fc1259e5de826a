#include "wearwell/models/fatigue/staircase_fit.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/fatigue/stair_scores.h"
#include "wearwell/present/plain.h"

namespace wearwell::fatigue {
namespace {

constexpr std::uint64_t seed = 20261127;
// Where the first replicates show a small p value, more tell how small.
constexpr std::size_t first_replicates = 1000, most_replicates = 10'000;
constexpr double in_question = 0.02;
constexpr std::ptrdiff_t fewest_levels = 3;

struct Limit {
  double location = 0, scale = 0;  // of log10
};

// The posterior mean of location and log scale given any outcomes, on a grid about the posterior of those that were seen.
class LimitGrid {
 public:
  LimitGrid(const StairFit& data, const StairDesign& design, const WeightedDraws& posterior)
      : levels_(design.log10_stress.size()) {
    const Axis location(posterior, [](const double* x) { return x[0]; });
    const Axis log_scale(posterior, [](const double* x) { return std::log(x[1]); });
    for (int i = 0; i < points; ++i) {
      for (int j = 0; j < points; ++j) {
        const Limit limit{within(data.log10_limit, location.at(i)),
                          within(data.sigma_limit, std::exp(log_scale.at(j)))};
        const double prior = log_density(data.log10_limit, limit.location).value +
                             log_density(data.sigma_limit, limit.scale).value +
                             std::log(limit.scale);
        if (!std::isfinite(prior)) continue;
        location_.push_back(limit.location);
        log_scale_.push_back(std::log(limit.scale));
        log_prior_.push_back(prior);
        for (std::size_t l = 0; l < levels_; ++l) {
          const double w = (design.log10_stress[l] - limit.location) / limit.scale;
          log_failing_.push_back(log_cdf(data.limit, w));
          log_surviving_.push_back(log_survival(data.limit, w));
        }
      }
    }
  }

  Limit mean(const StairOutcomes& sums) const {
    std::vector<std::size_t> tested;
    for (std::size_t l = 0; l < levels_; ++l) {
      if (sums.tests[l] > 0) tested.push_back(l);
    }
    std::vector<double> log_weight = log_prior_;
    for (std::size_t n = 0; n < log_weight.size(); ++n) {
      for (const std::size_t l : tested) {
        const double failures = sums.failures[l], survivors = sums.tests[l] - failures;
        if (failures > 0) log_weight[n] += failures * log_failing_[n * levels_ + l];
        if (survivors > 0) log_weight[n] += survivors * log_surviving_[n * levels_ + l];
      }
    }
    const double most = *std::max_element(log_weight.begin(), log_weight.end());
    constexpr double negligible = -40;
    double weights = 0, location = 0, log_scale = 0;
    for (std::size_t n = 0; n < log_weight.size(); ++n) {
      if (log_weight[n] < most + negligible) continue;
      const double weight = std::exp(log_weight[n] - most);
      weights += weight;
      location += weight * location_[n];
      log_scale += weight * log_scale_[n];
    }
    return {location / weights, std::exp(log_scale / weights)};
  }

 private:
  static double within(const Distribution& prior, double x) {
    return std::clamp(x, prior.lower, prior.upper);
  }

  static constexpr int points = 16;
  static constexpr double reach = 4;  // standard deviations

  struct Axis {
    double middle = 0, width = 0;

    Axis(const WeightedDraws& posterior, const std::function<double(const double*)>& of) {
      const QuantityDistribution distribution(posterior, of);
      middle = distribution.mean();
      width = reach * distribution.sd();
    }
    double at(int i) const { return middle + width * (2.0 * i / (points - 1) - 1); }
  };

  std::size_t levels_;
  std::vector<double> location_, log_scale_, log_prior_;  // of each node
  std::vector<double> log_failing_, log_surviving_;       // node by node, level by level
};

struct Judge {
  const StairFit& data;
  const StairDesign design = stair_design(data.tests);
  const WeightedSampler sampler;
  const LimitGrid grid;

  Judge(const StairFit& fit, const WeightedDraws& posterior)
      : data(fit), sampler(posterior), grid(fit, design, posterior) {}

  Limit estimate(const StairOutcomes& outcomes) const {
    return grid.mean(by_level(outcomes, design.log10_stress.size()));
  }
  StairScores scores(const StairOutcomes& outcomes) const {
    const Limit limit = estimate(outcomes);
    return stair_scores(design, outcomes, data.limit, limit.location, limit.scale);
  }
  StairScores replicate(std::size_t i) const {
    Rng rng(seed, i);
    const Eigen::VectorXd x = sampler(rng);
    return scores(design.simulate(data.limit, x[0], x[1], rng));
  }
};

struct PValues {
  double shape = 1, drift = 1;
};

// Equal statistics count: outcomes are few.
bool as_large(double replicated, double observed) {
  constexpr double rounding = 1e-9;
  return !(replicated < observed * (1 - rounding));
}

PValues p_values(const Judge& judge, const StairScores& observed) {
  std::vector<StairScores> replicates;
  const auto share = [&](const auto& statistic) {
    double large = 1;
    for (const StairScores& each : replicates)
      large += as_large(statistic(each), statistic(observed)) ? 1 : 0;
    return large / (static_cast<double>(replicates.size()) + 1);
  };
  PValues p;
  for (const std::size_t count : {first_replicates, most_replicates}) {
    const std::size_t begin = replicates.size();
    replicates.resize(count);
    tbb::parallel_for(begin, count, [&](std::size_t i) { replicates[i] = judge.replicate(i); });
    p.shape = share([](const StairScores& each) { return each.shape(); });
    p.drift = share([](const StairScores& each) { return each.drift(); });
    if (!(std::min(p.shape, p.drift) < in_question)) break;
  }
  return p;
}

// The level whose failures are farthest from what is expected.
std::string farthest_level(const Judge& judge) {
  const StairOutcomes sums = by_level(judge.design.observed, judge.design.log10_stress.size());
  const Limit limit = judge.estimate(judge.design.observed);
  std::size_t at = 0;
  double farthest = -1, expected = 0;
  for (std::size_t l = 0; l < sums.level.size(); ++l) {
    if (!(sums.tests[l] > 0)) continue;
    const double w = (judge.design.log10_stress[l] - limit.location) / limit.scale;
    const double fails = std::exp(log_cdf(judge.data.limit, w));
    const double survives = std::exp(log_survival(judge.data.limit, w));
    const double off = std::abs(sums.failures[l] - sums.tests[l] * fails) /
                       std::sqrt(sums.tests[l] * fails * survives);
    if (!(off > farthest)) continue;
    farthest = off;
    at = l;
    expected = sums.tests[l] * fails;
  }
  const double stress = from_si(judge.data.unit, std::pow(10, judge.design.log10_stress[at]));
  return fmt::format("at {} {} {:.0f} of {:.0f} tests failed, where {:.2g} are expected",
                     plain_number(stress), judge.data.unit.text, sums.failures[at], sums.tests[at],
                     expected);
}

}  // namespace

FitOutcome judge_staircase(const StairFit& data, const WeightedDraws& posterior) {
  FitOutcome outcome;
  const Judge judge(data, posterior);
  const StairOutcomes sums = by_level(judge.design.observed, judge.design.log10_stress.size());
  const bool levels = std::count_if(sums.tests.begin(), sums.tests.end(),
                                    [](double tests) { return tests > 0; }) >= fewest_levels;
  if (!levels && !judge.design.up_and_down) return outcome;
  const StairScores observed = judge.scores(judge.design.observed);
  const PValues p = p_values(judge, observed);
  if (levels)
    outcome.tests.push_back(
        {"distribution of the limit", p.shape,
         "failures do not follow the distribution of the limit: " + farthest_level(judge),
         "Look whether an outcome or a stress is mistaken, or specimens are of two kinds; if not, "
         "try another [law] limit_family."});
  if (judge.design.up_and_down)
    outcome.tests.push_back(
        {"drift with the order of the tests", p.drift,
         fmt::format("specimens bear {} the later they were tested",
                     observed.later > 0 ? "less" : "more"),
         "Look for a drift of the machine or its load cell, for another batch, or for specimens "
         "that were tested before."});
  for (FitTest& test : outcome.tests) {
    test.share = 1 / static_cast<double>(outcome.tests.size());
    outcome.p = std::min(outcome.p, test.judged());
  }
  return outcome;
}

Check staircase_fit_check(const StairFit& data, const WeightedDraws& posterior) {
  const FitOutcome outcome = judge_staircase(data, posterior);
  if (!outcome.tests.empty()) return fit_check(outcome);
  return {"fit", Verdict::pass,
          "tests under fewer than three stresses, not up and down, do not tell whether the "
          "distribution of the limit fits",
          ""};
}

}  // namespace wearwell::fatigue
