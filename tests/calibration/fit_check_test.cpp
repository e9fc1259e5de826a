// How often the checks of fit warn of data that the law itself made, and how often they fail: at
// most as often as they say, for few observations and many, with known and with fitted scatter,
// where items differ and where tests were stopped. Prints the shares; docs/reference/checks.md has them.
// WEARWELL_REPLICATIONS says how many studies of each kind.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "calibration/shares.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/infer/prior_checks.h"
#include "wearwell/infer/psis_loo.h"
#include "wearwell/models/bearing/wear_scores.h"
#include "wearwell/models/fatigue/sn_likelihood.h"
#include "wearwell/models/fatigue/sn_scores.h"
#include "wearwell/models/joint/archard.h"

namespace wearwell {
namespace {

constexpr std::uint64_t seed = 20261123;

struct Replication {
  double p = 1, p_loo = 0;
  bool excluded = false;  // the prior, which was right
};

struct Shares {
  double warned = 0, failed = 0, beyond = 0, far_beyond = 0, excluded = 0;
};

Distribution normal(double mean, double sd, double lower, double upper) {
  return make_distribution(Normal{mean, sd}, lower, upper);
}

Parameter parameter(const std::string& name, const Distribution& prior, double start) {
  return {name, "", Unit{"", 1, 0}, "", prior, start, 0.1 * start, 0, INFINITY};
}

Replication judge(const Posterior& posterior, const FitData& data, int index) {
  FitSettings settings;
  settings.method = Method::exact;
  settings.run = {1, 0, 1000, seed, static_cast<std::uint64_t>(index) * 2 + 1};
  settings.exact.tolerance = 1e-4;
  const Fit whole = fit(posterior, settings);
  const bool scored = data.terms && data.cheap;
  const Loo loo = leave_one_out(posterior, whole, scored ? &data.scores : nullptr);
  return {judge_fit(data, whole.pooled, loo).p, loo.p_loo(),
          prior_data_conflict(posterior, whole).detail.find("excludes") != std::string::npos};
}

template <class Replicate>
Shares simulate(const std::string& what, int otherwise, int parameters,
                const Replicate& replicate) {
  const int replications = wearwell::replications(otherwise);
  std::vector<Replication> all(static_cast<std::size_t>(replications));
  tbb::parallel_for(0, replications, [&](int i) {
    Rng rng(seed, static_cast<std::uint64_t>(i) * 2);
    all[static_cast<std::size_t>(i)] = replicate(rng, i);
  });
  Shares shares;
  for (const Replication& each : all) {
    shares.warned += (each.p < fit_warns_below) / double(replications);
    shares.failed += (each.p < fit_fails_below) / double(replications);
    shares.beyond += (each.p_loo > p_loo_warns_above(parameters)) / double(replications);
    shares.far_beyond += (each.p_loo > p_loo_fails_above(parameters)) / double(replications);
    shares.excluded += each.excluded / double(replications);
  }
  fmt::print(
      "{}: {} studies, warned {:.4f}, failed {:.4f}, p_loo beyond {:.4f}, far beyond {:.4f}, prior "
      "excluded {:.4f}\n",
      what, replications, shares.warned, shares.failed, shares.beyond, shares.far_beyond,
      shares.excluded);
  const auto expect = [&](double found, double most) {
    expect_share(static_cast<int>(std::lround(found * replications)), replications, most, what);
  };
  expect(shares.warned, fit_warns_below);
  expect(shares.failed, 2 * fit_fails_below);
  expect(shares.beyond, fit_warns_below);
  expect(shares.far_beyond, fit_fails_below);
  expect(shares.excluded, 2.7e-3 * parameters);
  return shares;
}

// Volumes after even or early inspections; `outlier` is added to the last, in sigma.
Replication joint_study(Rng& rng, int index, std::size_t n, double bend) {
  const Distribution k_prior = normal(7e-13, 2e-13, 0, INFINITY),
                     sigma_prior = make_distribution(Uniform{}, 1e-10, 15e-9);
  const double k = quantile(k_prior, rng.uniform()), sigma = quantile(sigma_prior, rng.uniform());
  joint::Inspections inspections;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = (double(i) + 1) / double(n);
    inspections.work.push_back(1.2e5 * share);
    inspections.volume.push_back(k * inspections.work.back() + sigma * rng.normal() +
                                 bend * sigma * (share - 0.5) * (share - 0.5));
  }
  const Posterior posterior(
      {parameter("k", k_prior, 7e-13), parameter("sigma", sigma_prior, 5e-9)},
      joint::archard_likelihood({}, ObservationFamily::normal, inspections, n));
  const FitData data{joint::archard_scores({}, ObservationFamily::normal, inspections),
                     {},
                     {{"friction work", inspections.work}},
                     Rise{"", inspections.work, inspections.volume, {}, true}};
  return judge(posterior, data, index);
}

TEST(FitCheckCalibration, Joint) {
  for (const std::size_t n : {3u, 5u, 20u}) {
    simulate(fmt::format("joint, {} inspections", n), 600, 2,
             [n](Rng& rng, int i) { return joint_study(rng, i, n, 0); });
  }
}

// The test itself must be able to fail: a law that bends by ten sigma over twenty inspections.
TEST(FitCheckCalibration, SeesABentLaw) {
  int failed = 0;
  for (int i = 0; i < 50; ++i) {
    Rng rng(seed, static_cast<std::uint64_t>(i) * 2);
    failed += joint_study(rng, i, 20, 40).p < fit_fails_below;
  }
  EXPECT_GE(failed, 40);
}

Replication bearing_study(Rng& rng, int index, std::size_t bearings, bool scatter, bool known) {
  bearing::WearModel model;
  if (known) model.depth_error = 2e-6;
  model.has_scatter = scatter;
  const Distribution k_prior = make_distribution(Lognormal{2e-15, 0.5}, 0, INFINITY);
  const Distribution sigma_prior = normal(0, 4e-6, 0, INFINITY),
                     scatter_prior = normal(0, 0.5, 0, INFINITY);
  const double k = quantile(k_prior, rng.uniform());
  const double sigma = known ? 2e-6 : quantile(sigma_prior, rng.uniform());
  const double between = scatter ? quantile(scatter_prior, rng.uniform()) : 0;
  bearing::Inspections inspections;
  std::vector<double> loading;
  for (std::size_t b = 0; b < bearings; ++b) {
    const double own = k * std::exp(between * rng.normal());
    for (const double turns : {5e4, 1e5, 2e5}) {
      bearing::Duty duty;
      duty.radius = 10e-3, duty.clearance = 30e-6, duty.pressure = 1e6, duty.revolutions = turns;
      inspections.duty.push_back(duty);
      inspections.bearing.push_back(b);
      const double depth = bearing::depth_functions({duty}, own).front().depth(std::log(own));
      inspections.depth.push_back(depth + sigma * rng.normal());
      loading.push_back(turns * duty.pressure);
    }
  }
  if (*std::max_element(inspections.depth.begin(), inspections.depth.end()) <= 0) return {};
  std::vector<Parameter> parameters = {parameter("k", k_prior, bearing::guess(inspections).k)};
  if (!known) parameters.push_back(parameter("sigma", sigma_prior, 3e-6));
  if (scatter) parameters.push_back(parameter("k_scatter", scatter_prior, 0.3));
  const Posterior posterior(parameters,
                            bearing::wear_likelihood(model, inspections, inspections.depth.size()));
  const FitData data{bearing::wear_scores(model, inspections),
                     {},
                     {{"loading", loading}},
                     Rise{"", loading, inspections.depth,
                          scatter ? inspections.bearing : std::vector<std::size_t>{}, true},
                     "row",
                     !scatter,
                     !scatter};
  return judge(posterior, data, index);
}

TEST(FitCheckCalibration, Bearing) {
  simulate("bearing, gauge known, 3 inspections", 600, 1,
           [](Rng& rng, int i) { return bearing_study(rng, i, 1, false, true); });
  simulate("bearing, scatter fitted, 12 inspections", 300, 2,
           [](Rng& rng, int i) { return bearing_study(rng, i, 4, false, false); });
  simulate("five bearings that differ, gauge known", 100, 2,
           [](Rng& rng, int i) { return bearing_study(rng, i, 5, true, true); });
}

Replication sn_study(Rng& rng, int index, const fatigue::SnLaw& law, int repetitions,
                     double longest) {
  const std::vector<Distribution> priors = {normal(9.3, 0.1, -INFINITY, INFINITY),
                                            normal(-0.1, 0.02, -INFINITY, -0.04),
                                            normal(0, 0.4, 0.02, INFINITY)};
  std::vector<double> truth;
  for (const Distribution& prior : priors) truth.push_back(quantile(prior, rng.uniform()));
  fatigue::LifeTests tests;
  FitData data;
  data.drivers = {{"stress", {}}};
  Rise rise;
  for (const double amplitude : {500e6, 430e6, 370e6, 320e6}) {
    for (int i = 0; i < repetitions; ++i) {
      const fatigue::Stress stress{amplitude, 0};
      const double z = law.family == fatigue::LifeFamily::weibull
                           ? quantile(StandardDistribution::smallest_extreme_value, rng.uniform())
                           : rng.normal();
      const double life =
          std::pow(10, law.log10_life(truth.data(), std::log10(amplitude)) + truth[2] * z);
      const bool stopped = life > longest;
      tests.push_back({stress, stopped ? fatigue::Outcome::runout : fatigue::Outcome::failure,
                       std::min(life, longest), 0, 1});
      data.drivers[0].value.push_back(std::log10(amplitude));
      if (stopped) continue;
      rise.driver.push_back(-std::log10(amplitude));
      rise.value.push_back(std::log10(life));
    }
  }
  data.scores = fatigue::sn_scores(law, tests);
  data.rise = rise;
  const Posterior posterior({parameter("log10_a", priors[0], 9.3),
                             {"b", "", Unit{"", 1, 0}, "", priors[1], -0.1, 0.02},
                             parameter("sigma", priors[2], 0.3)},
                            fatigue::sn_likelihood(law, tests, tests.size()));
  return judge(posterior, data, index);
}

TEST(FitCheckCalibration, SnWithRunOuts) {
  fatigue::SnLaw law;
  law.correction = fatigue::MeanStress::none;
  simulate("S-N, 4 levels of 2 tests, log-normal", 200, 3,
           [&](Rng& rng, int i) { return sn_study(rng, i, law, 2, INFINITY); });
  law.family = fatigue::LifeFamily::weibull;
  simulate("S-N, 4 levels of 4 tests, Weibull, stopped at 1e6", 100, 3,
           [&](Rng& rng, int i) { return sn_study(rng, i, law, 4, 1e6); });
}

}  // namespace
}  // namespace wearwell
