#include "wearwell/models/recurrence/trend_tests.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <functional>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/normal_score.h"

namespace wearwell::recurrence {
namespace {

constexpr std::uint64_t seed_of_samples = 20261126;
constexpr std::size_t fewest_samples = 250, most_samples = 10'000, most_evaluations = 10'000'000;

std::size_t random_failures(const UnitHistory& unit) {
  return unit.failures.size() - (unit.ends_at_failure ? 1 : 0);
}

// `u`: ages as shares of the end of observation; sorted here.
double crow_statistic(std::vector<double> u) {
  std::sort(u.begin(), u.end());
  const auto m = static_cast<double>(u.size());
  double logs = 0;
  for (const double each : u) logs -= std::log(each);
  const double beta = (m - 1) / logs;  // the unbiased estimate
  double sum = 1 / (12 * m);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double off = std::pow(u[i], beta) - (2 * static_cast<double>(i) + 1) / (2 * m);
    sum += off * off;
  }
  return sum;
}

// The share of samples, each from its own random stream, that are `as_large` as the data, which count as one of them. `size`
// is the cost of one sample.
double share_as_large(std::size_t size, const std::function<bool(Rng& rng)>& as_large) {
  const std::size_t samples = std::clamp(most_evaluations / size, fewest_samples, most_samples);
  std::vector<char> large(samples);
  tbb::parallel_for(std::size_t{0}, samples, [&](std::size_t s) {
    Rng rng(seed_of_samples, s);
    large[s] = as_large(rng);
  });
  const auto count = static_cast<double>(std::count(large.begin(), large.end(), 1));
  return (count + 1) / (static_cast<double>(samples) + 1);
}

bool counted_by_interval(const std::vector<UnitHistory>& units) {
  return !units.empty() && units.front().grouped;
}

constexpr const char* no_ages = "failures are counted by interval";

// The expected failures of each interval by maximum likelihood.
std::vector<double> expected_by_power_law(const std::vector<Gap>& gaps) {
  double longest = 0, failures = 0;
  for (const Gap& gap : gaps) {
    longest = std::max(longest, gap.to);
    failures += static_cast<double>(*gap.count);
  }
  const auto length = [&](const Gap& gap, double beta) {
    return std::pow(gap.to / longest, beta) - std::pow(gap.from / longest, beta);
  };
  const auto sum_of = [&](double beta) {
    double sum = 0;
    for (const Gap& gap : gaps) sum += length(gap, beta);
    return sum;
  };
  const auto loss = [&](double log_beta) {  // less the log-likelihood, at the best lambda
    const double beta = std::exp(log_beta);
    double sum = failures * std::log(sum_of(beta));
    for (const Gap& gap : gaps)
      if (*gap.count > 0) sum -= static_cast<double>(*gap.count) * std::log(length(gap, beta));
    return sum;
  };
  constexpr double least = -4, most = 4;
  constexpr int bits = 26;
  const double beta =
      std::exp(boost::math::tools::brent_find_minima(loss, least, most, bits).first);
  std::vector<double> expected;
  for (const Gap& gap : gaps) expected.push_back(failures * length(gap, beta) / sum_of(beta));
  return expected;
}

}  // namespace

TrendTest grouped_power_law_test(const std::vector<Gap>& gaps) {
  constexpr double fewest = 5;
  TrendTest test;
  std::vector<Gap> sorted = gaps;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Gap& a, const Gap& b) { return a.to < b.to; });
  for (const Gap& gap : sorted) test.failures += *gap.count;
  std::vector<std::pair<double, double>> joined;  // number and expectation
  const std::vector<double> expected =
      test.failures > 0 ? expected_by_power_law(sorted) : std::vector<double>();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (joined.empty() || joined.back().second >= fewest) joined.push_back({0, 0});
    joined.back().first += static_cast<double>(*sorted[i].count);
    joined.back().second += expected[i];
  }
  if (joined.size() > 1 && joined.back().second < fewest) {
    const auto rest = joined.back();
    joined.pop_back();
    joined.back().first += rest.first;
    joined.back().second += rest.second;
  }
  if (joined.size() < 3) {
    test.problem = "it needs three intervals of which each has at least five expected failures";
    return test;
  }
  for (const auto& [number, mean] : joined)
    test.statistic += (number - mean) * (number - mean) / mean;
  test.p =
      boost::math::gamma_q(0.5 * (static_cast<double>(joined.size()) - 2), 0.5 * test.statistic);
  return test;
}

TrendTest laplace_test(const std::vector<UnitHistory>& units) {
  TrendTest test;
  if (counted_by_interval(units)) {
    test.problem = no_ages;
    return test;
  }
  double sum = 0, variance = 0;
  for (const UnitHistory& unit : units) {
    const std::size_t count = random_failures(unit);
    const double middle = 0.5 * (unit.start + unit.end), length = unit.end - unit.start;
    for (std::size_t i = 0; i < count; ++i) sum += unit.failures[i] - middle;
    variance += static_cast<double>(count) * length * length / 12;
    test.failures += count;
  }
  if (test.failures == 0) {
    test.problem = "no failure within an observation";
    return test;
  }
  test.statistic = sum / std::sqrt(variance);
  test.p = 2 * normal_cdf(-std::abs(test.statistic));
  return test;
}

TrendTest cramer_von_mises_test(const std::vector<UnitHistory>& units) {
  TrendTest test;
  std::vector<double> shares;
  for (const UnitHistory& unit : units) {
    if (unit.start > 0) {
      test.problem = "it needs units that are observed from age 0";
      return test;
    }
    for (std::size_t i = 0; i < random_failures(unit); ++i)
      shares.push_back(unit.failures[i] / unit.end);
  }
  // A failure at the end of an observation by a time limit has no logarithm to estimate beta from, nor does one alone.
  constexpr std::size_t fewest = 3;
  test.failures = shares.size();
  const auto within = std::count_if(shares.begin(), shares.end(), [](double u) { return u < 1; });
  if (static_cast<std::size_t>(within) < fewest) {
    test.problem = "it needs at least three failures within the observations";
    return test;
  }
  test.statistic = crow_statistic(shares);
  test.p = crow_p_value(test.statistic, shares.size());
  return test;
}

double crow_p_value(double statistic, std::size_t failures) {
  return share_as_large(failures, [&](Rng& rng) {
    std::vector<double> u(failures);
    for (double& each : u) each = rng.uniform();
    return crow_statistic(std::move(u)) >= statistic;
  });
}

TrendTest dispersion_test(const std::vector<UnitHistory>& units,
                          const std::vector<double>& weights) {
  TrendTest test;
  std::vector<double> cumulated, counts;
  double sum = 0;
  bool truncated = false;
  for (std::size_t i = 0; i < units.size(); ++i) {
    cumulated.push_back(sum += weights[i]);
    counts.push_back(static_cast<double>(units[i].failures.size()));
    test.failures += units[i].failures.size();
    truncated = truncated || units[i].ends_at_failure;
  }
  if (units.size() < 2 || test.failures < 2 || truncated) {
    test.problem = truncated ? "observations that end at a failure fix the number of failures"
                             : "it needs two units and two failures";
    return test;
  }
  const auto statistic = [&](const std::vector<double>& of) {
    double squares = 0;
    for (std::size_t i = 0; i < units.size(); ++i) {
      const double expected = static_cast<double>(test.failures) * weights[i] / sum;
      squares += (of[i] - expected) * (of[i] - expected) / expected;
    }
    return squares;
  };
  test.statistic = statistic(counts);
  const double least = test.statistic * (1 - 1e-9);  // equal counts are as large
  test.p = share_as_large(std::max(units.size(), test.failures), [&](Rng& rng) {
    std::vector<double> drawn(units.size());
    for (std::size_t k = 0; k < test.failures; ++k) {
      const auto at = std::upper_bound(cumulated.begin(), cumulated.end(), sum * rng.uniform());
      drawn[std::min<std::size_t>(static_cast<std::size_t>(at - cumulated.begin()),
                                  units.size() - 1)] += 1;
    }
    return statistic(drawn) >= least;
  });
  return test;
}

}  // namespace wearwell::recurrence
