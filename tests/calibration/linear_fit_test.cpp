// How often the check of fit accuses a right linear model, whatever the number of its parameters, and how often it sees
// that errors are not normal or scatter more and more, beside the classical tests of studentized residuals. Draws are those
// of the posterior for the prior 1/sigma, which is known exactly. Prints the shares; docs/reference/checks.md has them.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <functional>

#include "calibration/shares.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/infer/loo.h"
#include "wearwell/infer/score_tests.h"
#include "wearwell/math/normality.h"

namespace wearwell {
namespace {

constexpr std::uint64_t seed = 20261126;
constexpr double level = 0.01;
constexpr double two_sided_at_level = 2.5758;  // qnorm(0.995)

using Error = std::function<double(std::size_t i, Rng& rng)>;

struct Design {
  std::string name;
  Eigen::MatrixXd columns;
  std::vector<double> driver;
  std::vector<std::size_t> machine;
};

// Powers of x, which goes evenly from 1 to 10.
Design polynomial(std::size_t rows, Eigen::Index parameters) {
  Design design{fmt::format("{} rows, {} parameters of the mean", rows, parameters), {}, {}, {}};
  design.columns.resize(static_cast<Eigen::Index>(rows), parameters);
  for (std::size_t i = 0; i < rows; ++i) {
    const double x = 1 + 9 * static_cast<double>(i) / static_cast<double>(rows - 1);
    design.driver.push_back(x);
    design.machine.push_back((i * 7) % 3);
    for (Eigen::Index p = 0; p < parameters; ++p)
      design.columns(static_cast<Eigen::Index>(i), p) = std::pow(x, static_cast<double>(p));
  }
  return design;
}

// A mean for each machine.
Design means(std::size_t machines, std::size_t readings) {
  Design design{
      fmt::format("means of {} machines of {} readings each", machines, readings), {}, {}, {}};
  design.columns.setZero(static_cast<Eigen::Index>(machines * readings),
                         static_cast<Eigen::Index>(machines));
  for (std::size_t i = 0; i < machines * readings; ++i) {
    design.driver.push_back(static_cast<double>(i / machines));
    design.machine.push_back(i % machines);
    design.columns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i % machines)) = 1;
  }
  return design;
}

struct Judged {
  double p = 1, shape = 1, trend = 1, between = 1;
  bool classical_shape = false, classical_trend = false;
};

Judged judge(const Design& design, const Error& error, std::uint64_t stream) {
  Rng rng(seed, stream);
  const Eigen::Index n = design.columns.rows(), p = design.columns.cols();
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) y[i] = error(static_cast<std::size_t>(i), rng);
  // Parameters are coordinates along orthonormal columns, and the logarithm of sigma.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(design.columns);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(n, p);
  const Eigen::VectorXd estimate = q.transpose() * y, residual = y - q * estimate;
  WeightedDraws draws;
  constexpr Eigen::Index count = 400;
  draws.values.resize(count, p + 1);
  draws.weights.setConstant(count, 1.0 / count);
  for (Eigen::Index s = 0; s < count; ++s) {
    double chi_squared = 0;
    for (Eigen::Index i = p; i < n; ++i) chi_squared += std::pow(rng.normal(), 2);
    const double sigma = std::sqrt(residual.squaredNorm() / chi_squared);
    for (Eigen::Index j = 0; j < p; ++j) draws.values(s, j) = estimate[j] + sigma * rng.normal();
    draws.values(s, p) = std::log(sigma);
  }
  FitData data;
  data.scores = [&](const double* x) {
    const Eigen::VectorXd z = (y - q * Eigen::Map<const Eigen::VectorXd>(x, p)) / std::exp(x[p]);
    std::vector<NormalScore> scores;
    for (const double each : z) scores.push_back({each, each});
    return scores;
  };
  data.drivers = {{"x", design.driver}};
  data.labels = {{"machine", design.machine}};
  const FitOutcome outcome = judge_fit(data, draws, Loo{});
  Judged judged;
  judged.p = outcome.p;
  for (const FitTest& test : outcome.tests) {
    if (test.name == "distribution of residuals") judged.shape = test.p;
    if (test.name == "scatter along x") judged.trend = test.p;
    if (test.name == "scatter between levels of machine") judged.between = test.p;
  }
  std::vector<double> studentized, size;
  for (Eigen::Index i = 0; i < n; ++i) {
    studentized.push_back(residual[i] / std::sqrt(1 - q.row(i).squaredNorm()));
    size.push_back(std::abs(studentized.back()));
  }
  judged.classical_shape = anderson_darling_test(studentized).p < level;
  judged.classical_trend =
      std::abs(scatter_trend_score(centered_ranks(size, {}), design.driver)) > two_sided_at_level;
  return judged;
}

struct Found {
  int count = 0;
  std::vector<Judged> all;

  template <class Holds>
  int of(const Holds& holds) const {
    return static_cast<int>(std::count_if(all.begin(), all.end(), holds));
  }
};

Found simulate(const Design& design, const std::string& errors, const Error& error, int otherwise) {
  Found found{replications(otherwise), {}};
  found.all.resize(static_cast<std::size_t>(found.count));
  tbb::parallel_for(0, found.count, [&](int i) {
    found.all[static_cast<std::size_t>(i)] = judge(design, error, static_cast<std::uint64_t>(i));
  });
  const auto share = [&](const auto& holds) { return 100.0 * found.of(holds) / found.count; };
  fmt::print(
      "linear, {}, {}, {} studies: warned {:.2f} %, failed {:.2f} %; p below 0.01: distribution "
      "{:.2f} % (classical {:.2f} %), scatter along x {:.2f} % (classical {:.2f} %), between "
      "machines {:.2f} %\n",
      design.name, errors, found.count,
      share([](const Judged& j) { return j.p < fit_warns_below; }),
      share([](const Judged& j) { return j.p < fit_fails_below; }),
      share([](const Judged& j) { return j.shape < level; }),
      share([](const Judged& j) { return j.classical_shape; }),
      share([](const Judged& j) { return j.trend < level; }),
      share([](const Judged& j) { return j.classical_trend; }),
      share([](const Judged& j) { return j.between < level; }));
  std::fflush(stdout);
  return found;
}

const Error normal = [](std::size_t, Rng& rng) { return rng.normal(); };

TEST(LinearFit, RightStudiesAreRarelyWarnedOf) {
  for (const Design& design :
       {polynomial(5, 1), polynomial(8, 2), polynomial(12, 3), polynomial(20, 4), polynomial(30, 2),
        means(10, 3), polynomial(100, 3)}) {
    const Found found = simulate(design, "normal errors", normal, 400);
    const int n = found.count;
    expect_share(found.of([](const Judged& j) { return j.p < fit_warns_below; }), n, 0.01,
                 design.name + ", warned");
    expect_share(found.of([](const Judged& j) { return j.p < fit_fails_below; }), n, 0.002,
                 design.name + ", failed");
    // Tests of few residuals that share parameters are approximate.
    constexpr double nearly = 2 * level;
    expect_share(found.of([](const Judged& j) { return j.shape < level; }), n, nearly,
                 design.name + ", distribution");
    expect_share(found.of([](const Judged& j) { return j.trend < level; }), n, nearly,
                 design.name + ", scatter along x");
    expect_share(found.of([](const Judged& j) { return j.between < level; }), n, nearly,
                 design.name + ", scatter between machines");
  }
}

TEST(LinearFit, WrongDistributionsAreFoundAsClassicalTestsDo) {
  const auto expect = [](const Design& design, const std::string& errors, const Error& error) {
    const Found found = simulate(design, errors, error, 200);
    expect_power(found.of([](const Judged& j) { return j.shape < level && !j.classical_shape; }),
                 found.of([](const Judged& j) { return j.shape >= level && j.classical_shape; }),
                 found.count, design.name + ", " + errors);
  };
  const Error student = [](std::size_t, Rng& rng) {
    const double a = rng.normal(), b = rng.normal();
    return rng.normal() / std::sqrt(0.5 * (a * a + b * b));
  };
  const Error exponential = [](std::size_t, Rng& rng) { return -std::log(rng.uniform()); };
  for (const Design& design : {polynomial(12, 3), polynomial(20, 4), polynomial(30, 2)}) {
    expect(design, "Student's t of 2", student);
    expect(design, "exponential errors", exponential);
  }
}

TEST(LinearFit, GrowingScatterIsFoundAsClassicalTestsDo) {
  for (const Design& design : {polynomial(20, 4), polynomial(30, 2), polynomial(60, 3)}) {
    const Found found = simulate(
        design, "scatter in proportion to x",
        [&](std::size_t i, Rng& rng) { return design.driver[i] * rng.normal(); }, 200);
    expect_power(found.of([](const Judged& j) { return j.trend < level && !j.classical_trend; }),
                 found.of([](const Judged& j) { return j.trend >= level && j.classical_trend; }),
                 found.count, design.name);
  }
}

}  // namespace
}  // namespace wearwell
