// How often the check of fit accuses right S-N studies of thirty tests, and how often it sees a second failure mode,
// scatter that grows with life and long tails, beside classical tests of the residuals of least squares at the same
// level. Prints the shares; docs/reference/checks.md has them. WEARWELL_REPLICATIONS says how many studies of each kind.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>

#include "calibration/shares.h"
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

// log10 of a life, given log10 of stress over 500 MPa and log10 of life on the line.
using Life = std::function<double(double log10_stress, double line, Rng& rng)>;

struct Kind {
  std::string name;
  Life life;
  double longest = INFINITY;  // tests that last longer are run-outs
  fatigue::LifeFamily family = fatigue::LifeFamily::log10_normal;
};

struct Judged {
  double p = 1, shape = 1, scatter = 1, order = 1;
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

Judged study(const Kind& kind, std::uint64_t stream) {
  Rng rng(seed, 2 * stream);
  const Distribution wide = make_distribution(Normal{9.3, 1}, -INFINITY, INFINITY);
  const Distribution slope = make_distribution(Normal{-0.1, 0.1}, -INFINITY, -0.01);
  const Distribution scatter = make_distribution(Normal{0, 1}, 0, INFINITY);
  const double truth[] = {9.3, -0.1, 0.15};
  fatigue::SnLaw law;
  law.correction = fatigue::MeanStress::none;
  law.family = kind.family;
  fatigue::LifeTests tests;
  Points points;
  FitData data;
  data.drivers = {{"stress", {}}};
  for (int l = 0; l < levels; ++l) {
    const double log10_stress = 8.7 - 0.05 * l;
    for (int i = 0; i < repetitions; ++i) {
      const double line = law.log10_life(truth, log10_stress);
      const double life = std::pow(10, kind.life(log10_stress, line, rng));
      const bool stopped = life > kind.longest;
      tests.push_back({{std::pow(10, log10_stress), 0},
                       stopped ? fatigue::Outcome::runout : fatigue::Outcome::failure,
                       std::min(life, kind.longest),
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
    if (test.name == "order along stress") judged.order = test.p;
  }
  judge_by_least_squares(points, judged);
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

Found simulate(const Kind& kind, int otherwise) {
  Found found{replications(otherwise), {}};
  found.all.resize(static_cast<std::size_t>(found.count));
  tbb::parallel_for(0, found.count, [&](int i) {
    found.all[static_cast<std::size_t>(i)] = study(kind, static_cast<std::uint64_t>(i));
  });
  const auto share = [&](const auto& holds) { return 100.0 * found.of(holds) / found.count; };
  fmt::print(
      "S-N, {}, {} studies: warned {:.2f} %, failed {:.2f} %; p below 0.01: distribution {:.2f} % "
      "(classical {:.2f} %), scatter {:.2f} % (classical {:.2f} %), order {:.2f} %\n",
      kind.name, found.count, share([](const Judged& j) { return j.p < fit_warns_below; }),
      share([](const Judged& j) { return j.p < fit_fails_below; }),
      share([](const Judged& j) { return j.shape < level; }),
      share([](const Judged& j) { return j.classical_shape; }),
      share([](const Judged& j) { return j.scatter < level; }),
      share([](const Judged& j) { return j.classical_scatter; }),
      share([](const Judged& j) { return j.order < level; }));
  std::fflush(stdout);
  return found;
}

const Life right = [](double, double line, Rng& rng) { return line + 0.15 * rng.normal(); };
const Life extreme = [](double, double line, Rng& rng) {
  return line + 0.15 * quantile(StandardDistribution::smallest_extreme_value, rng.uniform());
};

TEST(SnFitPower, RightStudiesAreRarelyWarnedOf) {
  using fatigue::LifeFamily;
  for (const Kind& kind :
       {Kind{"right, log10-normal", right}, Kind{"right, log10-normal, stopped at 8e7", right, 8e7},
        Kind{"right, Weibull", extreme, INFINITY, LifeFamily::weibull},
        Kind{"right, Weibull, stopped at 8e7", extreme, 8e7, LifeFamily::weibull}}) {
    const Found found = simulate(kind, 300);
    expect_share(found.of([](const Judged& j) { return j.p < fit_warns_below; }), found.count, 0.01,
                 kind.name + ", warned");
    expect_share(found.of([](const Judged& j) { return j.p < fit_fails_below; }), found.count,
                 0.002, kind.name + ", failed");
  }
}

TEST(SnFitPower, SecondModesAndLongTails) {
  const auto expect = [](const Kind& kind) {
    const Found found = simulate(kind, 150);
    expect_power(found.of([](const Judged& j) { return j.shape < level && !j.classical_shape; }),
                 found.of([](const Judged& j) { return j.shape >= level && j.classical_shape; }),
                 found.count, kind.name);
  };
  expect({"30 % by a mode of a tenth of the life", [](double, double line, Rng& rng) {
            return line + (rng.uniform() < 0.3 ? -1 : 0) + 0.15 * rng.normal();
          }});
  // Whichever comes first: a second mode with as long a life at 400 MPa, of twice the slope.
  expect({"a competing mode", [](double log10_stress, double line, Rng& rng) {
            const double other = line - 10 * (log10_stress - 8.6);
            return std::min(line + 0.05 * rng.normal(), other + 0.4 * rng.normal());
          }});
  expect({"Student's t of 2", [](double, double line, Rng& rng) {
            const double a = rng.normal(), b = rng.normal();
            return line + 0.15 * rng.normal() / std::sqrt(0.5 * (a * a + b * b));
          }});
}

TEST(SnFitPower, ScatterThatGrowsWithLife) {
  const Kind kind{"scatter that grows with life", [](double, double line, Rng& rng) {
                    return line + 0.1 * std::pow(10, 0.25 * (line - 6)) * rng.normal();
                  }};
  const Found found = simulate(kind, 150);
  expect_power(found.of([](const Judged& j) { return j.scatter < level && !j.classical_scatter; }),
               found.of([](const Judged& j) { return j.scatter >= level && j.classical_scatter; }),
               found.count, kind.name);
}

// A knee that only run-outs tell of: lives beyond it are thirty times those on the line. No classical test is beside it.
// Run-outs below a knee are what the law allows: the check does not see it, and must not accuse by them either.
TEST(SnFitPower, KneesThatRunOutsAloneShowAreNotSeen) {
  const Found found =
      simulate({"a knee below 400 MPa, stopped at 1.5e8",
                [](double log10_stress, double line, Rng& rng) {
                  return line + (log10_stress < 8.6 ? 1.5 : 0) + 0.15 * rng.normal();
                },
                1.5e8},
               150);
  const int failed = found.of([](const Judged& j) { return j.p < fit_fails_below; });
  expect_share(failed, found.count, 0.05, "knees that fail");
}

}  // namespace
}  // namespace wearwell
