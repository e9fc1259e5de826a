// How often the check of fit accuses right studies of lives and readings, and how often it sees what is wrong, beside the
// classical test with estimated parameters at the same level. Prints the shares; docs/reference/checks.md has them.
// WEARWELL_REPLICATIONS says how many studies of each kind.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <optional>

#include "calibration/formula_design.h"
#include "calibration/shares.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/loo.h"
#include "wearwell/infer/score_tests.h"
#include "wearwell/math/normality.h"
#include "wearwell/models/formula_model/formula_fit_data.h"

namespace wearwell::formula_model {
namespace {

constexpr std::uint64_t seed = 20261124;
constexpr double level = 0.01;

std::string life_study(const std::string& likelihood) {
  return "[data.columns]\ny = \"y\"\nx = \"x\"\nmachine = \"machine\"\n[likelihood.y]\n" +
         likelihood +
         R"(
[prior]
size = { distribution = "lognormal", median = 100, log_sd = 1 }
shape = { distribution = "lognormal", median = 1, log_sd = 1 }
[predict]
b_lives = [10]
)";
}

const std::string weibull =
    life_study("family = \"weibull\"\nscale = \"size\"\nshape = \"1/shape\"\n");
const std::string lognormal =
    life_study("family = \"lognormal\"\nmedian = \"size\"\nlog_sd = \"shape\"\n");
const std::string gamma_lives =
    life_study("family = \"gamma\"\nscale = \"size\"\nshape = \"1/shape\"\n");
const std::string line = R"([data.columns]
y = "y"
x = "x"
machine = "machine"
[likelihood.y]
family = "normal"
mean = "a + b*x"
sd = "sigma"
[prior]
a = { distribution = "normal", mean = 2, sd = 10 }
b = { distribution = "normal", mean = 1, sd = 10 }
sigma = { distribution = "half-normal", scale = 10 }
)";
const std::string level_reading = R"([data.columns]
y = "y"
x = "x"
machine = "machine"
[likelihood.y]
family = "normal"
mean = "a"
sd = "sigma"
[prior]
a = { distribution = "normal", mean = 2, sd = 10 }
sigma = { distribution = "half-normal", scale = 10 }
)";

const std::string growing = R"([data.columns]
y = "y"
x = "x"
machine = "machine"
[likelihood.y]
family = "normal"
mean = "a"
sd = "sigma*x^power"
[prior]
a = { distribution = "normal", mean = 2, sd = 10 }
sigma = { distribution = "half-normal", scale = 10 }
power = { distribution = "normal", mean = 0, sd = 3 }
)";

FormulaDesign design(const std::string& text, std::size_t n) {
  std::vector<double> y, x;
  std::vector<std::string> machine;
  for (std::size_t i = 0; i < n; ++i) {
    y.push_back(static_cast<double>(i) + 1);
    x.push_back(1 + 9 * static_cast<double>(i) / static_cast<double>(n - 1));
    machine.push_back(std::string(1, static_cast<char>('a' + (i * 7) % 3)));
  }
  return {text, {numbers("y", y), numbers("x", x), texts("machine", machine)}};
}

FitOutcome judged(const FormulaDesign& own, const std::vector<Response>& responses, Rng& rng) {
  const auto rows = std::make_shared<const FormulaRows>(own.with(responses), responses.size());
  const ExactPosterior exact = exact_posterior(rows, 3e-3);
  EXPECT_EQ(exact.failure, "");
  if (!exact.failure.empty()) return {};
  const WeightedSampler sampler(exact.nodes);
  WeightedDraws draws;
  constexpr Eigen::Index count = 200;
  draws.values.resize(count, exact.nodes.values.cols());
  for (Eigen::Index i = 0; i < count; ++i) draws.values.row(i) = sampler(rng).transpose();
  draws.weights.setConstant(count, 1.0 / count);
  return judge_fit(*fit_data(rows), draws, Loo{});
}

double smallest_extreme(Rng& rng) {
  return std::log(-std::log(rng.uniform()));
}

double student(double freedom, Rng& rng) {
  double chi2 = 0;
  for (int i = 0; i < freedom; ++i) chi2 += std::pow(rng.normal(), 2);
  return rng.normal() / std::sqrt(chi2 / freedom);
}

// One response at x.
using Draw = std::function<double(double x, Rng& rng)>;
using Classical = std::function<double(const std::vector<double>& y)>;  // large where it rejects

struct Kind {
  std::string name;
  const std::string* study;
  std::size_t rows;
  Draw draw;
  std::optional<double> stopped = {};   // lives beyond are run-outs
  std::optional<double> interval = {};  // ratio of the ends of intervals
  std::string test = "distribution of residuals";
};

std::vector<double> values(const Kind& kind, const FormulaDesign& own, Rng& rng) {
  std::vector<double> y;
  const std::vector<double>& x = own.law->data.number("x")->values;
  for (std::size_t i = 0; i < kind.rows; ++i) y.push_back(kind.draw(x[i], rng));
  return y;
}

std::vector<Response> responses_of(const Kind& kind, const std::vector<double>& y) {
  std::vector<Response> all;
  for (const double at : y) {
    if (kind.interval) {
      const double step = std::log(*kind.interval), k = std::floor(std::log(at) / step);
      all.push_back({Censoring::interval, std::exp(k * step), std::exp((k + 1) * step)});
    } else if (kind.stopped && at > *kind.stopped) {
      all.push_back({.seen = Censoring::right, .at = *kind.stopped});
    } else {
      all.push_back({.at = at});
    }
  }
  return all;
}

struct Found {
  int count = 0, warned = 0, failed = 0, test = 0;
  int only_test = 0, only_classical = 0;  // of this test and the classical one
};

Found simulate(const Kind& kind, int otherwise, const Classical& classical = {},
               double critical = 0) {
  const int count = replications(otherwise);
  const FormulaDesign own = design(*kind.study, kind.rows);
  struct One {
    double p = 1, test = 1;
    bool classical = false;
  };
  std::vector<One> all(static_cast<std::size_t>(count));
  tbb::parallel_for(0, count, [&](int i) {
    Rng rng(seed, static_cast<std::uint64_t>(i));
    const std::vector<double> y = values(kind, own, rng);
    const FitOutcome outcome = judged(own, responses_of(kind, y), rng);
    One& one = all[static_cast<std::size_t>(i)];
    one.p = outcome.p;
    for (const FitTest& test : outcome.tests) {
      if (test.name == kind.test) one.test = test.p;
    }
    one.classical = classical && classical(y) > critical;
  });
  Found found{.count = count};
  int of_classical = 0;
  for (const One& one : all) {
    found.warned += one.p < fit_warns_below;
    found.failed += one.p < fit_fails_below;
    found.test += one.test < level;
    of_classical += one.classical;
    found.only_test += one.test < level && !one.classical;
    found.only_classical += one.test >= level && one.classical;
  }
  const auto percent = [&](int of) { return 100.0 * of / count; };
  fmt::print("{}, {} rows, {} studies: warned {:.2f} %, failed {:.2f} %; {} below 0.01: {:.2f} %",
             kind.name, kind.rows, count, percent(found.warned), percent(found.failed), kind.test,
             percent(found.test));
  if (classical) fmt::print(", classical {:.2f} %", percent(of_classical));
  fmt::print("\n");
  std::fflush(stdout);
  return found;
}

void expect_few(const Kind& kind, int otherwise) {
  const Found found = simulate(kind, otherwise);
  expect_share(found.warned, found.count, 0.01, kind.name + ", warned");
  expect_share(found.failed, found.count, 0.002, kind.name + ", failed");
  // Tests of few residuals that share parameters are approximate.
  expect_share(found.test, found.count, 2 * level, kind.name + ", " + kind.test);
}

void expect_as_classical(const Kind& kind, int otherwise, const Classical& classical,
                         double critical) {
  const Found found = simulate(kind, otherwise, classical, critical);
  expect_power(found.only_test, found.only_classical, found.count, kind.name);
}

// Anderson and Darling's statistic of logarithms in the distribution of smallest extremes, at the maximum of the likelihood
// (Stephens 1977, Biometrika 64, 583-588).
double weibull_statistic(const std::vector<double>& y) {
  const double n = static_cast<double>(y.size());
  std::vector<double> log_y;
  for (const double each : y) log_y.push_back(std::log(each));
  std::sort(log_y.begin(), log_y.end());
  const double mean = std::accumulate(log_y.begin(), log_y.end(), 0.0) / n;
  double low = 1e-2, high = 1e2, sum = 0;
  for (int i = 0; i < 100; ++i) {
    const double shape = std::sqrt(low * high);
    double moment = 0;
    sum = 0;
    for (const double each : log_y) {
      const double power = std::exp(shape * (each - log_y.back()));
      sum += power;
      moment += power * each;
    }
    (moment / sum - 1 / shape < mean ? low : high) = shape;
  }
  const double location = log_y.back() + std::log(sum / n) / low;
  double a = 0;
  for (std::size_t i = 0; i < log_y.size(); ++i) {
    const double z = low * (log_y[i] - location);
    const double other = low * (log_y[log_y.size() - 1 - i] - location);
    a += (2 * static_cast<double>(i) + 1) *
         (std::log(std::max(-std::expm1(-std::exp(z)), 1e-300)) - std::exp(other));
  }
  return -n - a / n;
}

double weibull_critical(std::size_t n) {
  constexpr std::size_t samples = 10'000;
  std::vector<double> statistics;
  Rng rng(seed, 1'000'000 + n);
  for (std::size_t i = 0; i < samples; ++i) {
    std::vector<double> y(n);
    for (double& each : y) each = std::exp(smallest_extreme(rng));
    statistics.push_back(weibull_statistic(y));
  }
  std::sort(statistics.begin(), statistics.end());
  return statistics[static_cast<std::size_t>((1 - level) * samples)];
}

double one_less_normal_p(const std::vector<double>& y) {
  return 1 - anderson_darling_test(y).p;
}

double one_less_lognormal_p(std::vector<double> y) {
  for (double& each : y) each = std::log(each);
  return one_less_normal_p(y);
}

// Spearman's rank correlation of the residuals of least squares with x: t, of n - 2 degrees of freedom.
double spearman_of_scatter(const std::vector<double>& y) {
  const double n = static_cast<double>(y.size());
  std::vector<double> x, residual;
  for (std::size_t i = 0; i < y.size(); ++i) x.push_back(static_cast<double>(i) - 0.5 * (n - 1));
  const double squares = std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
  const double slope = std::inner_product(x.begin(), x.end(), y.begin(), 0.0) / squares;
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / n;
  for (std::size_t i = 0; i < y.size(); ++i)
    residual.push_back(std::abs(y[i] - mean - slope * x[i]));
  return std::abs(scatter_trend_score(centered_ranks(residual, {}), x));
}
constexpr double two_sided_at_level = 2.5758;  // qnorm(0.995)

const Draw weibull_2 = [](double, Rng& rng) { return 100 * std::exp(smallest_extreme(rng) / 2); };
const Draw lognormal_1 = [](double, Rng& rng) { return 100 * std::exp(rng.normal()); };
const Draw straight = [](double x, Rng& rng) { return 2 + x + 0.5 * rng.normal(); };

TEST(FitPower, RightStudiesAreRarelyWarnedOf) {
  constexpr int studies = 400;
  expect_few({"Weibull", &weibull, 12, weibull_2}, studies);
  expect_few({"Weibull", &weibull, 100, weibull_2}, studies);
  expect_few({"Weibull, 30 % run-outs", &weibull, 60, weibull_2, 110}, studies);
  expect_few({"Weibull, 30 % run-outs", &weibull, 12, weibull_2, 110}, studies);
  expect_few({"lognormal, 10 % run-outs", &lognormal, 30, lognormal_1, 360}, studies);
  expect_few({"lognormal", &lognormal, 60, lognormal_1}, studies);
  expect_few({"lognormal, 60 % run-outs", &lognormal, 60, lognormal_1, 78}, studies);
  expect_few({"lognormal in intervals of a factor of 2", &lognormal, 60, lognormal_1, {}, 2.0},
             studies);
  expect_few({"gamma", &gamma_lives, 60,
              [](double, Rng& rng) { return -50 * std::log(rng.uniform() * rng.uniform()); }},
             studies);
  expect_few({"normal", &level_reading, 8, [](double, Rng& rng) { return 2 + rng.normal(); }},
             studies);
  expect_few({"normal about a line", &line, 30, straight}, studies);
  expect_few({"normal, a standard deviation that depends on x", &growing, 30,
              [](double x, Rng& rng) { return 2 + 0.5 * x * rng.normal(); }},
             studies);
  expect_few(
      {"normal about a line, scatter along x", &line, 100, straight, {}, {}, "scatter along x"},
      studies);
}

TEST(FitPower, WeibullOnOtherLives) {
  constexpr int studies = 200;
  const auto expect = [&](const std::string& name, std::size_t n, const Draw& draw) {
    expect_as_classical({name, &weibull, n, draw}, studies, weibull_statistic, weibull_critical(n));
  };
  expect("mixture of 30 % about 50 and 70 % about 1000", 60, [](double, Rng& rng) {
    return rng.uniform() < 0.3 ? 50 * std::exp(smallest_extreme(rng) / 1.5)
                               : 1000 * std::exp(smallest_extreme(rng) / 3);
  });
  expect("two groups about 100 and 500", 40, [](double, Rng& rng) {
    return (rng.uniform() < 0.5 ? 100 : 500) * std::exp(smallest_extreme(rng) / 8);
  });
  expect("lognormal lives", 100, lognormal_1);
  expect("threshold of 500", 60,
         [](double, Rng& rng) { return 500 + 1000 * std::exp(smallest_extreme(rng) / 1.2); });
  expect("undeclared truncation below the 30 % quantile", 60,
         [](double, Rng& rng) { return 100 * std::pow(-std::log(0.7 * rng.uniform()), 1 / 1.5); });
  expect("infant mortality of 20 %", 40, [](double, Rng& rng) {
    return rng.uniform() < 0.2 ? 10 * std::exp(smallest_extreme(rng) / 0.8)
                               : 200 * std::exp(smallest_extreme(rng) / 4);
  });
}

TEST(FitPower, LognormalAndNormalOnOthers) {
  constexpr int studies = 200;
  const auto weibull_08 = [](double, Rng& rng) {
    return 100 * std::exp(smallest_extreme(rng) / 0.8);
  };
  expect_as_classical({"lognormal on Weibull lives", &lognormal, 100, weibull_08}, studies,
                      one_less_lognormal_p, 1 - level);
  expect_as_classical({"normal on Student's t of 2", &level_reading, 30,
                       [](double, Rng& rng) { return 2 + student(2, rng); }},
                      studies, one_less_normal_p, 1 - level);
  expect_as_classical({"normal on a skewed response", &level_reading, 40,
                       [](double, Rng& rng) { return 2 - std::log(rng.uniform()); }},
                      studies, one_less_normal_p, 1 - level);
}

TEST(FitPower, ScatterThatFollowsTheMean) {
  constexpr int studies = 200;
  const auto expect = [&](const std::string& name, std::size_t n, const Draw& draw) {
    expect_as_classical({name, &line, n, draw, {}, {}, "scatter along x"}, studies,
                        spearman_of_scatter, two_sided_at_level);
  };
  const Draw in_proportion = [](double x, Rng& rng) { return (2 + x) * (1 + 0.2 * rng.normal()); };
  expect("scatter in proportion to the mean", 30, in_proportion);
  expect("scatter in proportion to the mean", 60, in_proportion);
  expect("scatter in proportion to x", 30,
         [](double x, Rng& rng) { return 2 + x * (1 + 0.3 * rng.normal()); });
}

}  // namespace
}  // namespace wearwell::formula_model
