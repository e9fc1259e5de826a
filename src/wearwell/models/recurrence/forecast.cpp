#include "wearwell/models/recurrence/forecast.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/math/root.h"
#include "wearwell/models/recurrence/renewal_function.h"
#include "wearwell/predict/count_quantile.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::recurrence {
namespace {

constexpr std::uint64_t seed_of_futures = 20261127;
constexpr std::size_t futures = 4000;
constexpr Eigen::Index draws_of_counts = 2000, draws_of_renewals = 400;

// Cumulative hazard until the next failure, `ahead` from now.
double hazard_ahead(const Process& process, const double* x, const UnitState& unit, double ahead) {
  if (process.minimal_repair())
    return process.mean_by(x, unit.age + ahead) - process.mean_by(x, unit.age);
  return weibull_hazard(x, unit.since_repair + ahead) - weibull_hazard(x, unit.since_repair);
}

void of_poisson(const Process& process, const WeightedDraws& all,
                const std::vector<UnitState>& units, double ahead, double outside,
                Forecast& found) {
  const auto mean = [&](const double* x) {
    double sum = 0;
    for (const UnitState& unit : units) sum += hazard_ahead(process, x, unit, ahead);
    return sum;
  };
  const WeightedDraws draws = thinned(all, draws_of_counts);
  std::vector<CountAtPoint> counts(static_cast<std::size_t>(draws.values.rows()));
  tbb::parallel_for(std::size_t{0}, counts.size(), [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double expected = mean(draws.values.row(row).data());
    counts[i] = {expected, expected, draws.weights[row]};
  });
  const QuantityDistribution expected(draws, mean);
  found.expected = expected.mean();
  found.low = expected.quantile(outside);
  found.high = expected.quantile(1 - outside);
  const double ends[] = {outside, 1 - outside};
  const std::vector<double> range = count_quantiles(counts, ends);
  found.count_low = range[0];
  found.count_high = range[1];
  for (const CountAtPoint& each : counts) found.any += each.weight * -std::expm1(-each.mean);
}

// The number of failures of one unit in one future.
double renewals(const double* x, double since_repair, double ahead, Rng& rng) {
  constexpr double most = 1e6;
  const auto next = [&](double since) {
    return x[1] * std::pow(weibull_hazard(x, since) - std::log(rng.uniform()), 1 / x[0]) - since;
  };
  double count = 0;
  for (double at = next(since_repair); at <= ahead && count < most; at += next(0)) ++count;
  return count;
}

void of_renewals(const WeightedDraws& all, const std::vector<UnitState>& units, double ahead,
                 double outside, Forecast& found) {
  const WeightedSampler sampler(all);
  std::vector<double> counts(futures);
  tbb::parallel_for(std::size_t{0}, futures, [&](std::size_t s) {
    Rng rng(seed_of_futures, s);
    const Eigen::VectorXd x = sampler(rng);
    for (const UnitState& unit : units)
      counts[s] += renewals(x.data(), unit.since_repair, ahead, rng);
  });
  std::sort(counts.begin(), counts.end());
  const auto at = [&](double p) {
    return counts[std::min(futures - 1, static_cast<std::size_t>(p * futures))];
  };
  found.count_low = at(outside);
  found.count_high = at(1 - outside);
  const auto none = std::upper_bound(counts.begin(), counts.end(), 0.0) - counts.begin();
  found.any = 1 - static_cast<double>(none) / futures;
  const QuantityDistribution expected(thinned(all, draws_of_renewals), [&](const double* x) {
    const RenewalFunction renewal(x[0], x[1], ahead);
    double sum = 0;
    for (const UnitState& unit : units) sum += renewal.expected(unit.since_repair);
    return sum;
  });
  found.expected = expected.mean();
  found.low = expected.quantile(outside);
  found.high = expected.quantile(1 - outside);
}

}  // namespace

UnitState state_at_end(const UnitHistory& unit) {
  return {unit.end, unit.failures.empty() ? unit.end : unit.end - unit.failures.back()};
}

Forecast forecast(const Process& process, const WeightedDraws& draws,
                  const std::vector<UnitState>& units, double ahead, double outside) {
  Forecast found;
  if (process.minimal_repair()) {
    of_poisson(process, draws, units, ahead, outside, found);
  } else {
    of_renewals(draws, units, ahead, outside, found);
  }
  return found;
}

double time_to_failure(const Process& process, const WeightedDraws& all, const UnitState& unit,
                       double p) {
  const WeightedDraws draws = thinned(all, draws_of_counts);
  const auto failed = [&](double log_time) {
    double sum = 0;
    for (Eigen::Index i = 0; i < draws.values.rows(); ++i)
      sum -= draws.weights[i] * std::expm1(-hazard_ahead(process, draws.values.row(i).data(), unit,
                                                         std::exp(log_time)));
    return sum - p;
  };
  constexpr double most_logarithm = 300, close = 1e-9;
  const double found = solve_increasing(failed, std::log(unit.age > 0 ? unit.age : 1.0), 1,
                                        {.absolute = close}, -most_logarithm, most_logarithm);
  return found >= most_logarithm ? INFINITY : std::exp(found);
}

std::vector<double> expected_failures(const Process& process, const double* x,
                                      const std::vector<double>& ages) {
  std::vector<double> means;
  if (process.minimal_repair()) {
    for (const double age : ages) means.push_back(process.mean_by(x, age));
  } else {
    const RenewalFunction renewal(x[0], x[1], ages.back());
    for (const double age : ages) means.push_back(renewal(age));
  }
  return means;
}

}  // namespace wearwell::recurrence
