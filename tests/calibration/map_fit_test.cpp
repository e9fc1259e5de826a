// How often the check of fit accuses right clutch campaigns, and how often it sees tails and plates that scatter differently,
// beside classical tests of the scaled studentized residuals at the same level. Each study searches its map as a campaign does,
// at few exponents. Prints the shares; docs/reference/checks.md has them. WEARWELL_REPLICATIONS says how many studies of each kind.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numeric>

#include "calibration/shares.h"
#include "wearwell/base/rng.h"
#include "wearwell/math/normality.h"
#include "wearwell/models/clutch/clutch_study.h"
#include "wearwell/models/clutch/map_fit.h"

namespace wearwell::clutch {
namespace {

constexpr double level = 0.01;
constexpr std::uint64_t seed = 20261128;
const std::vector<double> exponents = {0.5, 1.2};

const ClutchStudy& example() {
  static const ClutchStudy study =
      read_clutch_study(PROJECT_SOURCE_DIR "/examples/clutch/study.toml");
  return study;
}

struct Judged {
  double p = 1, shape = 1, between = 1;
  bool classical_shape = false, classical_between = false;
};

// Analysis of variance of absolute residuals between plates: Levene's test (1960).
double levene_p(const std::vector<double>& z, const std::vector<int>& plate) {
  std::map<int, std::pair<double, double>> levels;  // count, sum
  double all = 0, between = 0, within = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    levels[plate[i]].first += 1;
    levels[plate[i]].second += std::abs(z[i]);
    all += std::abs(z[i]) / static_cast<double>(z.size());
  }
  for (const auto& [at, sums] : levels)
    between += sums.first * std::pow(sums.second / sums.first - all, 2);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto& sums = levels[plate[i]];
    within += std::pow(std::abs(z[i]) - sums.second / sums.first, 2);
  }
  const double a = std::ssize(levels) - 1.0, b = std::ssize(z) - a - 1;
  const boost::math::fisher_f law(a, b);
  return cdf(complement(law, between / a / (within / b)));
}

Judged judge(const WearPoints& points) {
  const PairBest best = best_exponents(points, Surrogate::distance, exponents, {}, 1);
  const WearMap map =
      fit_map("selected", points, Surrogate::distance, best.r, best.q, 3, best.terms);
  const ScatterSearch scatter = fit_scatter(points, map);
  const ScatterLaw& law = scatter.candidates[scatter.best].law;
  const FitOutcome outcome = judge_map(points, map, law);
  Judged judged;
  judged.p = outcome.p;
  for (const FitTest& test : outcome.tests) {
    if (test.name == "distribution of residuals") judged.shape = test.p;
    if (test.name == "scatter between levels of plate") judged.between = test.p;
  }
  const Eigen::VectorXd z = scaled_residuals(points, map, law);
  const std::vector<double> list(z.begin(), z.end());
  judged.classical_shape = anderson_darling_test(list).p < level;
  judged.classical_between = levene_p(list, points.plate) < level;
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

Found simulate(const std::string& name, int otherwise,
               const std::function<WearPoints(std::uint64_t)>& points) {
  Found found{replications(otherwise), {}};
  found.all.resize(static_cast<std::size_t>(found.count));
  tbb::parallel_for(0, found.count, [&](int i) {
    found.all[static_cast<std::size_t>(i)] = judge(points(static_cast<std::uint64_t>(i)));
  });
  const auto share = [&](const auto& holds) { return 100.0 * found.of(holds) / found.count; };
  fmt::print(
      "clutch, {}, {} studies: warned {:.2f} %, failed {:.2f} %; p below 0.01: distribution {:.2f} "
      "% (classical {:.2f} %), scatter between plates {:.2f} % (classical {:.2f} %)\n",
      name, found.count, share([](const Judged& j) { return j.p < fit_warns_below; }),
      share([](const Judged& j) { return j.p < fit_fails_below; }),
      share([](const Judged& j) { return j.shape < level; }),
      share([](const Judged& j) { return j.classical_shape; }),
      share([](const Judged& j) { return j.between < level; }),
      share([](const Judged& j) { return j.classical_between; }));
  std::fflush(stdout);
  return found;
}

// The points of a whole simulated campaign: its cycles and weighings, run-in and plates fitted.
WearPoints of_campaign(std::uint64_t i) {
  const ClutchStudy& study = example();
  const Campaign campaign = simulate(study.campaign.design, *study.truth, 5000 + i).campaign;
  const WornBlocks blocks = worn_blocks(campaign);
  return wear_points(campaign, blocks.blocks, fit_run_in(blocks.blocks), false);
}

// The points of one campaign with other wear rates: those of the truth, and errors in its scatter.
using Error = std::function<double(int plate, Rng& rng)>;
WearPoints with_errors(const WearPoints& like, const Error& error, std::uint64_t i) {
  const Truth& truth = *example().truth;
  Rng rng(seed, i);
  WearPoints points = like;
  for (Eigen::Index j = 0; j < points.size(); ++j)
    points.w[j] = truth.w(points.at[static_cast<std::size_t>(j)]);
  const Eigen::VectorXd sd = point_sd(truth.scatter, points, points.w);
  for (Eigen::Index j = 0; j < points.size(); ++j)
    points.w[j] += sd[j] * error(points.plate[static_cast<std::size_t>(j)], rng);
  return points;
}

void expect_few(const Found& found, const std::string& name) {
  expect_share(found.of([](const Judged& j) { return j.p < fit_warns_below; }), found.count, 0.01,
               name + ", warned");
  expect_share(found.of([](const Judged& j) { return j.p < fit_fails_below; }), found.count, 0.002,
               name + ", failed");
}

TEST(MapFitCalibration, RightCampaignsAreRarelyWarnedOf) {
  const WearPoints like = of_campaign(0);
  const Error normal = [](int, Rng& rng) { return rng.normal(); };
  expect_few(
      simulate("normal errors", 200, [&](std::uint64_t i) { return with_errors(like, normal, i); }),
      "normal errors");
  expect_few(simulate("whole campaigns", 100, of_campaign), "whole campaigns");
}

TEST(MapFitCalibration, TailsAndPlatesAreFoundAsClassicalTestsDo) {
  const WearPoints like = of_campaign(0);
  const auto found = [&](const std::string& name, const Error& error) {
    return simulate(name, 100, [&](std::uint64_t i) { return with_errors(like, error, i); });
  };
  const Found tails = found("Student's t of 3", [](int, Rng& rng) {
    double squares = 0;
    for (int k = 0; k < 3; ++k) squares += std::pow(rng.normal(), 2) / 3;
    return rng.normal() / std::sqrt(squares);
  });
  expect_power(tails.of([](const Judged& j) { return j.shape < level && !j.classical_shape; }),
               tails.of([](const Judged& j) { return j.shape >= level && j.classical_shape; }),
               tails.count, "tails");
  const Found plates = found("three plates of three times the scatter", [](int plate, Rng& rng) {
    return (plate <= 3 ? 3 : 1) * rng.normal();
  });
  expect_power(plates.of([](const Judged& j) { return j.between < level && !j.classical_between; }),
               plates.of([](const Judged& j) { return j.between >= level && j.classical_between; }),
               plates.count, "plates");
}

}  // namespace
}  // namespace wearwell::clutch
