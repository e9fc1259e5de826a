// How often the check of fit accuses right S-N studies of thirty tests, and how often it sees a second failure mode,
// scatter that grows with life and long tails, beside classical tests of the residuals of least squares at the same
// level. Prints the shares; docs/reference/checks.md has them. WEARWELL_REPLICATIONS says how many studies of each kind.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>

#include "wearwell/base/rng.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/infer/psis_loo.h"
#include "wearwell/infer/score_tests.h"
#include "wearwell/math/normality.h"
#include "wearwell/models/fatigue/sn_likelihood.h"
#include "wearwell/models/fatigue/sn_scores.h"

namespace wearwell {
namespace {

constexpr std::uint64_t seed = 20261125;
constexpr double level = 0.01;
constexpr int levels = 6, repetitions = 5;

// Decades by which log10 life lies off the line, given that line.
using Error = std::function<double(double log10_life, Rng& rng)>;

struct Judged {
  double p = 1, shape = 1, scatter = 1;
  bool classical_shape = false, classical_scatter = false;
};

struct Points {
  std::vector<double> log10_stress, log10_life;
};

void judge_by_least_squares(const Points& points, Judged& judged) {
  const double n = static_cast<double>(points.log10_life.size());
  const auto centered = [&](std::vector<double> v) {
    const double mean = std::accumulate(v.begin(), v.end(), 0.0) / n;
    for (double& each : v) each -= mean;
    return v;
  };
  const std::vector<double> x = centered(points.log10_stress), y = centered(points.log10_life);
  const double slope = std::inner_product(x.begin(), x.end(), y.begin(), 0.0) /
                       std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
  std::vector<double> residual, size;
  for (std::size_t i = 0; i < x.size(); ++i) {
    residual.push_back(y[i] - slope * x[i]);
    size.push_back(std::abs(residual.back()));
  }
  judged.classical_shape = anderson_darling_test(residual).p < level;
  constexpr double two_sided_at_level = 2.5758;  // qnorm(0.995)
  judged.classical_scatter =
      std::abs(scatter_trend_score(centered_ranks(size, {}), centered_ranks(x, {}))) >
      two_sided_at_level;
}

Judged study(const Error& error, double longest, std::uint64_t stream) {
  Rng rng(seed, 2 * stream);
  const Law wide = make_law(Normal{9.3, 1}, -INFINITY, INFINITY);
  const Law slope = make_law(Normal{-0.1, 0.1}, -INFINITY, -0.01);
  const Law scatter = make_law(Normal{0, 1}, 0, INFINITY);
  const double truth[] = {9.3, -0.1, 0.15};
  fatigue::SnLaw law;
  law.correction = fatigue::MeanStress::none;
  fatigue::LifeTests tests;
  Points points;
  FitData data;
  data.drivers = {{"stress", {}}};
  for (int l = 0; l < levels; ++l) {
    const double log10_stress = 8.7 - 0.05 * l;
    for (int i = 0; i < repetitions; ++i) {
      const double line = law.log10_life(truth, log10_stress);
      const double life = std::pow(10, line + error(line, rng));
      const bool stopped = life > longest;
      tests.push_back({{std::pow(10, log10_stress), 0},
                       stopped ? fatigue::Outcome::runout : fatigue::Outcome::failure,
                       std::min(life, longest),
                       0,
                       1});
      data.drivers[0].value.push_back(log10_stress);
      points.log10_stress.push_back(log10_stress);
      points.log10_life.push_back(std::log10(tests.back().life));
    }
  }
  data.scores = fatigue::sn_scores(law, tests);
  const Posterior posterior(
      {{"log10_a", "", Unit{"", 1, 0}, "", wide, 9.3, 0.1, -INFINITY, INFINITY},
       {"b", "", Unit{"", 1, 0}, "", slope, -0.1, 0.02, -INFINITY, 0},
       {"sigma", "", Unit{"", 1, 0}, "", scatter, 0.2, 0.02, 0, INFINITY}},
      fatigue::sn_likelihood(law, tests, tests.size()));
  FitSettings settings;
  settings.method = Method::exact;
  settings.run = {1, 0, 400, seed, 2 * stream + 1};
  settings.exact.tolerance = 1e-3;
  const Fit whole = fit(posterior, settings);
  const FitOutcome outcome = judge_fit(data, whole.pooled, Loo{});
  Judged judged;
  judged.p = outcome.p;
  for (const FitTest& test : outcome.tests) {
    if (test.name == "distribution of residuals") judged.shape = test.p;
    if (test.name == "scatter along stress") judged.scatter = test.p;
  }
  judge_by_least_squares(points, judged);
  return judged;
}

struct Shares {
  int count = 0;
  double warned = 0, failed = 0, shape = 0, scatter = 0, classical_shape = 0, classical_scatter = 0;
};

Shares simulate(const std::string& name, const Error& error, int otherwise,
                double longest = INFINITY) {
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  const int count = wanted ? std::max(20, std::atoi(wanted)) : otherwise;
  std::vector<Judged> all(static_cast<std::size_t>(count));
  tbb::parallel_for(0, count, [&](int i) {
    all[static_cast<std::size_t>(i)] = study(error, longest, static_cast<std::uint64_t>(i));
  });
  Shares shares{.count = count};
  const auto share = [&](const auto& holds) {
    return static_cast<double>(std::count_if(all.begin(), all.end(), holds)) / count;
  };
  shares.warned = share([](const Judged& j) { return j.p < fit_warns_below; });
  shares.failed = share([](const Judged& j) { return j.p < fit_fails_below; });
  shares.shape = share([](const Judged& j) { return j.shape < level; });
  shares.scatter = share([](const Judged& j) { return j.scatter < level; });
  shares.classical_shape = share([](const Judged& j) { return j.classical_shape; });
  shares.classical_scatter = share([](const Judged& j) { return j.classical_scatter; });
  fmt::print(
      "S-N, {}, {} studies: warned {:.4f}, failed {:.4f}; distribution {:.4f} (classical {:.4f}), "
      "scatter {:.4f} (classical {:.4f})\n",
      name, count, shares.warned, shares.failed, shares.shape, shares.classical_shape,
      shares.scatter, shares.classical_scatter);
  std::fflush(stdout);
  return shares;
}

double error_of(double share, int count) {
  return 2 * std::sqrt(share * (1 - share) / count);
}

const Error right = [](double, Rng& rng) { return 0.15 * rng.normal(); };

TEST(SnFitPower, RightStudiesAreRarelyWarnedOf) {
  for (const double longest : {static_cast<double>(INFINITY), 1e6}) {
    const Shares shares =
        simulate(longest < INFINITY ? "right, stopped at 1e6" : "right", right, 300, longest);
    EXPECT_LE(shares.warned, 0.01 + 3 * std::sqrt(0.01 / shares.count));
    EXPECT_LE(shares.failed, 0.002 + 3 * std::sqrt(0.002 / shares.count));
  }
}

TEST(SnFitPower, SecondModesAndLongTails) {
  const auto expect = [](const std::string& name, const Error& error) {
    const Shares shares = simulate(name, error, 150);
    EXPECT_GE(shares.shape,
              shares.classical_shape - 0.05 - error_of(shares.classical_shape, shares.count))
        << name;
  };
  expect("30 % by a mode of a tenth of the life",
         [](double, Rng& rng) { return (rng.uniform() < 0.3 ? -1 : 0) + 0.15 * rng.normal(); });
  expect("Student's t of 2", [](double, Rng& rng) {
    const double a = rng.normal(), b = rng.normal();
    return 0.15 * rng.normal() / std::sqrt(0.5 * (a * a + b * b));
  });
}

TEST(SnFitPower, ScatterThatGrowsWithLife) {
  const Shares shares = simulate(
      "scatter that grows",
      [](double line, Rng& rng) { return 0.1 * std::pow(10, 0.25 * (line - 6)) * rng.normal(); },
      150);
  EXPECT_GE(shares.scatter,
            shares.classical_scatter - 0.05 - error_of(shares.classical_scatter, shares.count));
}

}  // namespace
}  // namespace wearwell
