// Simulation-based calibration (Talts et al. 2018) of the S-N model with Goodman's correction, with
// and without run-outs: parameters drawn from the prior, lives from the parameters, and then the
// rank of each true parameter among thinned posterior draws, which is even.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <boost/math/distributions/chi_squared.hpp>

#include "wearwell/base/rng.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/run_chains.h"
#include "wearwell/models/fatigue/sn_likelihood.h"

namespace wearwell::fatigue {
namespace {

constexpr int replications = 1000, draws = 1485, thin = 15, ranks = draws / thin + 1, bins = 20;
static_assert(ranks % bins == 0);
constexpr std::size_t unknowns = 4;

Distribution normal(double mean, double sd, double lower, double upper) {
  return make_distribution(Normal{mean, sd}, lower, upper);
}

// log10 a [Pa], b, log10 S_ut [Pa], sigma.
std::array<Distribution, unknowns> priors() {
  return {normal(9.3, 0.1, -INFINITY, INFINITY), normal(-0.1, 0.02, -INFINITY, -0.04),
          normal(9.1, 0.05, 8.9, INFINITY), normal(0, 0.4, 0.02, INFINITY)};
}

// Three tests each at four levels, two of them with mean stress.
LifeTests simulate(const SnLaw& law, const double* truth, double longest, Rng& rng) {
  LifeTests tests;
  for (const Stress stress : {Stress{500e6, 0}, {400e6, 200e6}, {400e6, 0}, {300e6, 300e6}}) {
    for (int repetition = 0; repetition < 3; ++repetition) {
      const double center = law.log10_life(truth, law.log10_reversed(truth, stress));
      const double z = law.family == LifeFamily::weibull
                           ? quantile(StandardDistribution::smallest_extreme_value, rng.uniform())
                           : rng.normal();
      const double life = std::pow(10, center + truth[3] * z);
      if (life > longest) {
        tests.push_back({stress, Outcome::runout, longest, 0, 1});
      } else {
        tests.push_back({stress, Outcome::failure, life, 0, 1});
      }
    }
  }
  return tests;
}

struct Replication {
  std::array<int, unknowns> rank{};
  int runouts = 0;
};

Replication replicate(const SnLaw& law, double longest, int index) {
  Rng rng(20261122, static_cast<std::uint64_t>(index) * 2);
  static constexpr const char* names[] = {"log10_a", "b", "log10_Sut", "sigma"};
  double truth[unknowns];
  std::vector<Parameter> parameters;
  for (std::size_t i = 0; i < unknowns; ++i) {
    const Distribution prior = priors()[i];
    truth[i] = quantile(prior, rng.uniform());
    parameters.push_back({names[i], "1", Unit{"1", 1, 0}, "", prior, quantile(prior, 0.5), 0.1});
  }
  const LifeTests tests = simulate(law, truth, longest, rng);
  const Posterior posterior(parameters, sn_likelihood(law, tests, tests.size()));
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  NutsSettings careful;
  careful.target_accept = 0.95;
  const Draws chains =
      run_nuts(posterior, whitening, careful,
               {1, 600, draws, 20261122, static_cast<std::uint64_t>(index) * 2 + 1});
  Replication result;
  for (const LifeTest& test : tests) result.runouts += test.outcome == Outcome::runout;
  for (int i = 0; i < draws; i += thin) {
    for (std::size_t p = 0; p < unknowns; ++p) {
      result.rank[p] += chains[0].values(i, static_cast<Eigen::Index>(p)) < truth[p];
    }
  }
  return result;
}

// The share of tests that ran out. A correct sampler fails one time in a thousand for each
// parameter, and the seed is fixed.
double calibrate(LifeFamily family, double longest) {
  SnLaw law;
  law.family = family;
  std::vector<Replication> all(replications);
  tbb::parallel_for(0, replications,
                    [&](int i) { all[static_cast<std::size_t>(i)] = replicate(law, longest, i); });
  double runouts = 0;
  for (const Replication& each : all) runouts += each.runouts;
  for (std::size_t p = 0; p < unknowns; ++p) {
    std::array<int, bins> count{};
    for (const Replication& each : all) {
      ++count[static_cast<std::size_t>(each.rank[p] * bins / ranks)];
    }
    constexpr double expected = 1.0 * replications / bins;
    double chi_squared = 0;
    for (const int c : count) chi_squared += std::pow(c - expected, 2) / expected;
    EXPECT_GT(cdf(complement(boost::math::chi_squared(bins - 1), chi_squared)), 0.001)
        << "parameter " << p << ": chi-squared " << chi_squared;
  }
  return runouts / (12.0 * replications);
}

TEST(SnCalibration, AllTestsBreak) {
  EXPECT_EQ(calibrate(LifeFamily::log10_normal, INFINITY), 0);
}

TEST(SnCalibration, ManyTestsRunOut) {
  const double share = calibrate(LifeFamily::log10_normal, 1e5);
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 0.9);
}

TEST(SnCalibration, WeibullLivesWithRunouts) {
  const double share = calibrate(LifeFamily::weibull, 1e5);
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 0.9);
}

}  // namespace
}  // namespace wearwell::fatigue
