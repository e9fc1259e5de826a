// Simulation-based calibration of repairable systems: parameters drawn from the prior, histories of units drawn from the
// parameters; the cdf of the true parameter, and of the number of failures that follow, must be uniform over replications. And
// how often the check of fit accuses right studies; docs/reference/checks.md has the shares.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdio>

#include "calibration/shares.h"
#include "wearwell/base/rng.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/infer/mode.h"
#include "wearwell/models/recurrence/forecast.h"
#include "wearwell/models/recurrence/process.h"

namespace wearwell::recurrence {
namespace {

constexpr std::uint64_t seed = 20261126;
constexpr double ahead = 0.5;

struct Kind {
  std::string name;
  ProcessKind process = ProcessKind::power_law;
  int units = 10;
  double scale = 3;  // median number of failures of one unit, or one over the scale of a gap
};

struct Judged {
  double beta = 0, second = 0, number = 0;  // cdf of the truth
  double p = 1;                             // of the check of fit
};

// The next failure of a unit after age `at`.
double next_failure(const Kind& kind, const double* x, double at, double last, Rng& rng) {
  const double hazard = -std::log(rng.uniform());
  if (kind.process == ProcessKind::power_law)
    return std::pow(std::pow(at, x[0]) + hazard / x[1], 1 / x[0]);
  return last + x[1] * std::pow(std::pow((at - last) / x[1], x[0]) + hazard, 1 / x[0]);
}

Judged replicate(const Kind& kind, std::uint64_t index) {
  Rng rng(seed, index);
  const Process process{kind.process, 1, 0, {}};
  const bool minimal = process.minimal_repair();
  const Distribution beta = make_distribution(Lognormal{1, 0.4}, 0, INFINITY),
                     second = make_distribution(
                         Lognormal{minimal ? kind.scale : 1 / kind.scale, 0.4}, 0, INFINITY);
  const double x[] = {quantile(beta, rng.uniform()), quantile(second, rng.uniform())};
  RecurrenceData data;
  std::vector<UnitState> states;
  double follow = 0;
  for (int i = 0; i < kind.units; ++i) {
    const double end = kind.units > 1 ? rng.uniform(0.3, 1) : 1;
    UnitHistory unit{"u", 0, end, {}, false};
    double last = 0;
    for (double at = next_failure(kind, x, 0, 0, rng); at <= end + ahead;
         at = next_failure(kind, x, at, at, rng)) {
      if (at > end) {
        ++follow;
        continue;
      }
      data.gaps.push_back({data.units.size(), last, at, true, last == 0});
      unit.failures.push_back(last = at);
    }
    data.gaps.push_back({data.units.size(), last, end, false, last == 0});
    states.push_back(state_at_end(unit));
    data.units.push_back(unit);
  }
  const Unit plain{"1", 1, 0};
  const Posterior posterior(
      {{"beta", "1", plain, "", beta, 1, 0.3, 0, INFINITY},
       {"second", "1", plain, "", second, quantile(second, 0.5), 0.3 * x[1], 0, INFINITY}},
      process_likelihood(process, data));
  const ExactPosterior exact =
      integrate(posterior, whitening_at(find_mode(posterior, posterior.start())));
  const WeightedDraws& nodes = exact.nodes;
  constexpr int draws = 400;
  const Draws drawn = independent_draws(posterior, exact, 1, draws, seed + 1, index);
  Judged judged;
  judged.beta = QuantityDistribution(nodes, [](const double* p) { return p[0]; }).cdf(x[0]);
  judged.second = QuantityDistribution(nodes, [](const double* p) { return p[1]; }).cdf(x[1]);
  const Forecast found = forecast(process, nodes, states, ahead);
  judged.number = follow >= found.count_low && follow <= found.count_high;
  FitData fit;
  fit.scores = process_scores(process, data);
  fit.drivers = {{"age", {}}};
  for (const Gap& gap : data.gaps) {
    fit.drivers[0].value.push_back(gap.from);
    fit.unit.push_back(gap.unit);
  }
  judged.p =
      judge_fit(fit, {drawn[0].values, Eigen::VectorXd::Constant(draws, 1.0 / draws), {}, {}}, {})
          .p;
  return judged;
}

void expect_uniform_cdf(const std::vector<double>& all, const std::string& what) {
  constexpr int bins = 20;
  std::vector<double> count(bins, 0.0);
  for (const double each : all)
    count[static_cast<std::size_t>(std::min(bins - 1.0, each * bins))] += 1;
  const double expected = static_cast<double>(all.size()) / bins;
  double sum = 0;
  for (const double c : count) sum += (c - expected) * (c - expected) / expected;
  EXPECT_GT(cdf(complement(boost::math::chi_squared(bins - 1), sum)), 0.001)
      << what << ": chi-squared " << sum;
}

void calibrate(const Kind& kind) {
  std::vector<Judged> all(static_cast<std::size_t>(replications(200)));
  tbb::parallel_for(std::size_t{0}, all.size(),
                    [&](std::size_t i) { all[i] = replicate(kind, i); });
  std::vector<double> beta, second;
  int warned = 0, failed = 0, inside = 0;
  for (const Judged& each : all) {
    beta.push_back(each.beta);
    second.push_back(each.second);
    warned += each.p < fit_warns_below;
    failed += each.p < fit_fails_below;
    inside += each.number > 0;
  }
  const int n = static_cast<int>(all.size());
  fmt::print(
      "{}, {} studies: check of fit warned {:.2f} %, failed {:.2f} %; forecast interval holds "
      "{:.1f} %\n",
      kind.name, n, 100.0 * warned / n, 100.0 * failed / n, 100.0 * inside / n);
  std::fflush(stdout);
  expect_uniform_cdf(beta, kind.name + ", beta");
  expect_uniform_cdf(second, kind.name + ", second");
  expect_share(warned, n, 0.01, kind.name + ", warned");
  expect_share(failed, n, 0.002, kind.name + ", failed");
  expect_share(n - inside, n, 0.1,
               kind.name + ", outside the 90 % interval");  // whole numbers hold more
}

TEST(RecurrenceCalibration, PowerLaw) {
  calibrate({"power law, 10 units"});
  calibrate({"power law, 40 units with few failures", ProcessKind::power_law, 40, 0.8});
  calibrate({"power law, one unit", ProcessKind::power_law, 1, 20});
}

TEST(RecurrenceCalibration, Renewal) {
  calibrate({"renewal, 10 units", ProcessKind::renewal, 10, 3});
  calibrate({"renewal, one unit", ProcessKind::renewal, 1, 20});
}

}  // namespace
}  // namespace wearwell::recurrence
