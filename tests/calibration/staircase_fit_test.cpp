// How often the check of fit accuses right staircases, and how often it sees a limit that drifts and specimens of two kinds,
// beside the classical test at the maximum of the likelihood (Pearson's, and the score test), whose critical value is simulated.
// Prints the shares; docs/reference/checks.md has them. WEARWELL_REPLICATIONS says how many studies of each kind.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "calibration/shares.h"
#include "wearwell/base/rng.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/mode.h"
#include "wearwell/models/fatigue/staircase_fit.h"

namespace wearwell::fatigue {
namespace {

constexpr std::uint64_t seed = 20261127;
constexpr double level = 0.01, middle = 8.5, step = 0.03;

const Distribution location_prior = make_distribution(Normal{middle, 0.3}, -INFINITY, INFINITY);
const Distribution scale_prior = make_distribution(HalfNormal{0.1}, 0, INFINITY);

// log10 of the limit of the item tested `share` of the way through.
using ItemLimit = std::function<double(double share, Rng& rng)>;

struct Kind {
  std::string name;
  ItemLimit limit;
  int tests = 30;
  int at_each = 0;  // of so many levels' tests; 0: up and down
  StandardDistribution family = StandardDistribution::normal;
};

std::vector<StairTest> simulated(const Kind& kind, Rng& rng) {
  std::vector<StairTest> tests;
  double at = middle + step * rng.uniform(-1, 1);
  for (int i = 0; i < kind.tests; ++i) {
    if (kind.at_each > 0) {
      const int levels = kind.tests / kind.at_each;
      at = middle + step * (i / kind.at_each - 0.5 * (levels - 1));
    }
    const bool failed = at > kind.limit(i / (kind.tests - 1.0), rng);
    tests.push_back({std::pow(10, at), failed, 1});
    if (kind.at_each == 0) at += failed ? -step : step;
  }
  return tests;
}

// The maximum of the likelihood of a + b x (normal), by Fisher's scoring; b is kept from infinity, where levels are separated.
struct Classical {
  double shape = 0, drift = 0;
};

Classical classical(const std::vector<StairTest>& tests) {
  const auto n = static_cast<Eigen::Index>(tests.size());
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i)
    x[i] = (std::log10(tests[static_cast<std::size_t>(i)].stress) - middle) / step;
  double a = 0, b = 0.5;
  constexpr double least = 0.02, most = 5;
  Eigen::VectorXd score(n), information(n), w(n), p(n);
  const auto evaluate = [&] {
    for (Eigen::Index i = 0; i < n; ++i) {
      w[i] = std::clamp(a + b * x[i], -30.0, 30.0);
      p[i] = cdf(StandardDistribution::normal, w[i]);
      const double density = log_density(StandardDistribution::normal, w[i]);
      const double if_failed = std::exp(density - log_cdf(StandardDistribution::normal, w[i])),
                   if_survived =
                       -std::exp(density - log_survival(StandardDistribution::normal, w[i]));
      score[i] = tests[static_cast<std::size_t>(i)].failed ? if_failed : if_survived;
      information[i] = -if_failed * if_survived;
    }
  };
  for (int k = 0; k < 60; ++k) {
    evaluate();
    const double s = information.sum(), sx = information.dot(x),
                 sxx = information.dot(x.cwiseProduct(x)), det = s * sxx - sx * sx;
    if (!(det > 1e-12)) break;
    const double u = score.sum(), v = score.dot(x);
    a += std::clamp((sxx * u - sx * v) / det, -1.0, 1.0);
    b = std::clamp(b + std::clamp((s * v - sx * u) / det, -0.5, 0.5), least, most);
  }
  evaluate();
  Classical found;
  std::map<double, std::array<double, 3>> levels;  // failures, expected, variance
  for (Eigen::Index i = 0; i < n; ++i) {
    auto& at = levels[std::round(1e6 * x[i])];
    at[0] += tests[static_cast<std::size_t>(i)].failed ? 1 : 0;
    at[1] += p[i];
    at[2] += p[i] * (1 - p[i]);
  }
  for (const auto& [at, sums] : levels)
    found.shape += std::pow(sums[0] - sums[1], 2) / std::max(sums[2], 1e-9);
  Eigen::MatrixXd columns(n, 3);
  for (Eigen::Index i = 0; i < n; ++i)
    columns.row(i) << 1, x[i], static_cast<double>(i) / double(n);
  const Eigen::Matrix3d all = columns.transpose() * information.asDiagonal() * columns;
  const Eigen::Vector2d part = all.topLeftCorner<2, 2>().ldlt().solve(all.topRightCorner<2, 1>());
  const double left = all(2, 2) - all.topRightCorner<2, 1>().dot(part);
  const Eigen::Vector3d total = columns.transpose() * score;
  if (left > 1e-9) found.drift = std::pow(total[2] - part.dot(total.head<2>()), 2) / left;
  return found;
}

struct Judged {
  double p = 1, shape = 1, drift = 1;
  Classical by_likelihood;
};

Judged judge(const Kind& kind, std::uint64_t stream) {
  Rng rng(seed, stream);
  const StairFit data{kind.family, simulated(kind, rng), location_prior, scale_prior,
                      Unit{"Pa", 1, 0}};
  const auto one = [](const char* name, const Distribution& prior) {
    return Parameter{name, "1", Unit{"1", 1, 0}, "", prior, quantile(prior, 0.5), 0.1};
  };
  const Posterior posterior({one("log10_limit", location_prior), one("sigma_limit", scale_prior)},
                            staircase_likelihood(data.limit, data.tests));
  const ExactPosterior exact =
      integrate(posterior, whitening_at(find_mode(posterior, posterior.start())));
  const FitOutcome outcome = judge_staircase(data, exact.nodes);
  Judged judged{outcome.p, 1, 1, classical(data.tests)};
  for (const FitTest& test : outcome.tests) {
    if (test.name == "distribution of the limit") judged.shape = test.p;
    if (test.name == "drift with the order of the tests") judged.drift = test.p;
  }
  return judged;
}

std::vector<Judged> simulate(const Kind& kind, int otherwise) {
  std::vector<Judged> all(static_cast<std::size_t>(replications(otherwise)));
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) { all[i] = judge(kind, i); });
  return all;
}

template <class Holds>
int count(const std::vector<Judged>& all, const Holds& holds) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), holds));
}

double percent(int found, const std::vector<Judged>& all) {
  return 100.0 * found / static_cast<double>(all.size());
}

const ItemLimit right = [](double, Rng& rng) { return middle + step * rng.normal(); };

void expect_few(const Kind& kind) {
  const std::vector<Judged> all = simulate(kind, 400);
  const int warned = count(all, [](const Judged&j) { return j.p < fit_warns_below; }),
            failed = count(all, [](const Judged&j) { return j.p < fit_fails_below; }),
            shape = count(all, [](const Judged&j) { return j.shape < level; }),
            drift = count(all, [](const Judged&j) { return j.drift < level; });
  fmt::print(
      "staircase, {}, {} studies: warned {:.2f} %, failed {:.2f} %; p below 0.01: distribution "
      "{:.2f} %, drift {:.2f} %\n",
      kind.name, all.size(), percent(warned, all), percent(failed, all), percent(shape, all),
      percent(drift, all));
  std::fflush(stdout);
  const int n = static_cast<int>(all.size());
  expect_share(warned, n, 0.01, kind.name + ", warned");
  expect_share(failed, n, 0.002, kind.name + ", failed");
  expect_share(shape, n, level, kind.name + ", distribution");
  expect_share(drift, n, level, kind.name + ", drift");
}

// The classical statistic beyond which one right study of a hundred lies at most, whatever the scatter: a third of a step, one
// step or three.
double critical(const Kind& kind, double Classical::*statistic) {
  constexpr std::size_t studies = 4000;
  double largest = 0;
  for (const double scatter : {step / 3, step, 3 * step}) {
    Kind same = kind;
    same.limit = [scatter](double, Rng& rng) { return middle + scatter * rng.normal(); };
    std::vector<double> values(studies);
    tbb::parallel_for(std::size_t{0}, studies, [&](std::size_t i) {
      Rng rng(seed + 1, i);
      values[i] = classical(simulated(same, rng)).*statistic;
    });
    std::sort(values.begin(), values.end());
    largest = std::max(largest, values[studies - studies / 100]);
  }
  return largest;
}

void expect_as_classical(const Kind& kind, double Judged::*p, double Classical::*statistic) {
  const std::vector<Judged> all = simulate(kind, 200);
  const double beyond = critical(kind, statistic);
  const auto ours = [&](const Judged& j) { return j.*p < level; };
  const auto theirs = [&](const Judged& j) { return j.by_likelihood.*statistic > beyond; };
  fmt::print(
      "staircase, {}, {} studies: warned {:.2f} %, failed {:.2f} %; p below 0.01 {:.2f} %, "
      "classical {:.2f} %\n",
      kind.name, all.size(),
      percent(count(all, [](const Judged& j) { return j.p < fit_warns_below; }), all),
      percent(count(all, [](const Judged& j) { return j.p < fit_fails_below; }), all),
      percent(count(all, ours), all), percent(count(all, theirs), all));
  std::fflush(stdout);
  expect_power(count(all, [&](const Judged& j) { return ours(j) && !theirs(j); }),
               count(all, [&](const Judged& j) { return theirs(j) && !ours(j); }),
               static_cast<int>(all.size()), kind.name);
}

TEST(StaircaseFitCalibration, RightSequencesAreRarelyWarnedOf) {
  const ItemLimit extreme = [](double, Rng& rng) {
    return middle + step * quantile(StandardDistribution::smallest_extreme_value, rng.uniform());
  };
  for (const int tests : {12, 30, 100})
    expect_few({fmt::format("{} up and down", tests), right, tests});
  expect_few({"30 up and down, a scatter of a third of a step",
              [](double, Rng& rng) { return middle + step / 3 * rng.normal(); }});
  expect_few({"30 up and down, a scatter of three steps",
              [](double, Rng& rng) { return middle + 3 * step * rng.normal(); }});
  expect_few({"30 up and down, smallest extreme value", extreme, 30, 0,
              StandardDistribution::smallest_extreme_value});
  expect_few({"10 at each of 5 levels", right, 50, 10});
  expect_few({"40 at each of 4 levels", right, 160, 40});
}

TEST(StaircaseFitCalibration, DriftsAreFoundAsClassicalTestsDo) {
  const auto drifting = [](double steps) {
    return [steps](double share, Rng& rng) {
      return middle + step * (steps * (share - 0.5) + rng.normal());
    };
  };
  expect_as_classical({"30 up and down, a drift of 3 steps", drifting(3)}, &Judged::drift,
                      &Classical::drift);
  expect_as_classical({"60 up and down, a drift of 3 steps", drifting(3), 60}, &Judged::drift,
                      &Classical::drift);
}

TEST(StaircaseFitCalibration, TwoKindsAreFoundAsClassicalTestsDo) {
  const auto mixed = [](double share_of_other, double steps) {
    return [=](double, Rng& rng) {
      const double other = rng.uniform() < share_of_other ? steps : 0;
      return middle + step * (other + rng.normal());
    };
  };
  expect_as_classical(
      {"100 up and down, 20 % with a limit higher by 10 steps", mixed(0.2, 10), 100},
      &Judged::shape, &Classical::shape);
  expect_as_classical(
      {"20 at each of 6 levels, 30 % with a limit lower by 10 steps", mixed(0.3, -10), 120, 20},
      &Judged::shape, &Classical::shape);
  expect_as_classical(
      {"40 at each of 6 levels, 20 % with a limit higher by 10 steps", mixed(0.2, 10), 240, 40},
      &Judged::shape, &Classical::shape);
}

}  // namespace
}  // namespace wearwell::fatigue
