// Simulation-based calibration (Talts et al. 2018) of what has a fatigue limit: a staircase, a knee with a
// horizontal limit that scatters, and the random limit. Parameters are drawn from the prior, tests from the
// parameters; the rank of each true parameter among thinned draws of the posterior is even.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/distributions/chi_squared.hpp>

#include "wearwell/base/rng.h"
#include "wearwell/infer/independence_sampler.h"
#include "wearwell/infer/mode.h"
#include "wearwell/models/fatigue/sn_likelihood.h"
#include "wearwell/models/fatigue/staircase.h"

namespace wearwell::fatigue {
namespace {

constexpr int chains = 4, draws = 150, thin = 5, ranks = chains * draws / thin, bins = 10;
static_assert(ranks % bins == 0);
constexpr std::uint64_t seed = 20261122;

using Simulate =
    std::function<std::shared_ptr<const LogDensity>(const std::vector<double>& truth, Rng& rng)>;

Distribution normal(double mean, double sd, double lower = -INFINITY, double upper = INFINITY) {
  return make_distribution(Normal{mean, sd}, lower, upper);
}

// Draws by the rule that a study follows, leaps where evaluations take long (run_chains.h). A correct sampler fails one time in a thousand for each parameter, and the seed is fixed.
void calibrate(const std::vector<Distribution>& priors, int replications,
               const Simulate& simulate) {
  std::vector<std::vector<int>> rank(static_cast<std::size_t>(replications),
                                     std::vector<int>(priors.size(), 0));
  tbb::parallel_for(std::size_t{0}, rank.size(), [&](std::size_t i) {
    Rng rng(seed, 100 * i);
    std::vector<double> truth;
    std::vector<Parameter> parameters;
    for (const Distribution& prior : priors) {
      truth.push_back(quantile(prior, rng.uniform()));
      parameters.push_back({std::to_string(truth.size()), "1", Unit{"1", 1, 0}, "", prior,
                            quantile(prior, 0.5), 0.1});
    }
    const Posterior posterior(parameters, simulate(truth, rng));
    NutsSettings careful;
    careful.target_accept = 0.95;
    const Draws drawn =
        run_nuts_or_independence(posterior, whitening_at(find_mode(posterior, posterior.start())),
                                 careful, {chains, 1000, draws, seed, 100 * i + 1});
    // One less than there are ranks.
    for (int k = thin; k < chains * draws; k += thin) {
      for (std::size_t p = 0; p < priors.size(); ++p) {
        rank[i][p] += drawn[static_cast<std::size_t>(k / draws)].values(
                          k % draws, static_cast<Eigen::Index>(p)) < truth[p];
      }
    }
  });
  for (std::size_t p = 0; p < priors.size(); ++p) {
    std::array<int, bins> count{};
    for (const auto& each : rank) ++count[static_cast<std::size_t>(each[p] * bins / ranks)];
    const double expected = 1.0 * replications / bins;
    double chi_squared = 0;
    for (const int c : count) chi_squared += std::pow(c - expected, 2) / expected;
    EXPECT_GT(cdf(complement(boost::math::chi_squared(bins - 1), chi_squared)), 0.001)
        << "parameter " << p << ": chi-squared " << chi_squared;
  }
}

// Fifteen tests up and down in steps of 5 %.
TEST(LimitCalibration, Staircase) {
  calibrate({normal(8.5, 0.05), normal(0, 0.04, 0.003)}, 300,
            [](const std::vector<double>& truth, Rng& rng) {
              std::vector<StairTest> tests;
              double stress = 8.5;
              for (int i = 0; i < 15; ++i) {
                const bool failed = stress > truth[0] + truth[1] * rng.normal();
                tests.push_back({std::pow(10, stress), failed, 1});
                stress += failed ? -0.02 : 0.02;
              }
              return staircase_likelihood(StandardDistribution::normal, tests);
            });
}

// Three tests each at six levels about the limit, stopped after 1e7 cycles.
Simulate tests_of(const SnLaw& law) {
  return [law](const std::vector<double>& truth, Rng& rng) {
    LifeTests tests;
    for (const double mega : {500, 430, 370, 320, 280, 250}) {
      for (int repetition = 0; repetition < 3; ++repetition) {
        const Stress stress{mega * 1e6, 0};
        const double center = law.log10_life_of_item(
            truth.data(), law.log10_reversed(truth.data(), stress), rng.normal());
        const double life = std::pow(
            10, center + truth[static_cast<std::size_t>(law.sigma_index())] * rng.normal());
        tests.push_back(life < 1e7 ? LifeTest{stress, Outcome::failure, life, 0, 1}
                                   : LifeTest{stress, Outcome::runout, 1e7, 0, 1});
      }
    }
    return sn_likelihood(law, tests, tests.size());
  };
}

SnLaw limited(SnCurve curve) {
  SnLaw law;
  law.correction = MeanStress::none;
  law.curve = curve;
  law.limit = StandardDistribution::normal;
  if (curve == SnCurve::knee) law.second_slope = SecondSlope::infinite;
  return law;
}

TEST(LimitCalibration, KneeWithAHorizontalLimit) {
  calibrate({normal(6, 1, 2), normal(5.8, 0.2), normal(0, 0.3, 0.03), normal(8.47, 0.04),
             normal(0, 0.05, 0.005)},
            100, tests_of(limited(SnCurve::knee)));
}

TEST(LimitCalibration, RandomLimit) {
  calibrate({normal(9.5, 0.1), normal(-0.22, 0.03, -INFINITY, -0.05), normal(0, 0.3, 0.03),
             normal(8.4, 0.04), normal(0, 0.05, 0.005)},
            60, tests_of(limited(SnCurve::basquin)));
}

}  // namespace
}  // namespace wearwell::fatigue
