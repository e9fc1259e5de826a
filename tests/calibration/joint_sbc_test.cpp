// Simulation-based calibration (Talts et al. 2018) of the joint model: parameters drawn from the
// prior, data drawn from the parameters, and then the rank of the true parameter among thinned
// posterior draws, which is uniform when prior, likelihood, transforms and sampler all belong
// together.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <boost/math/distributions/chi_squared.hpp>

#include "wearwell/base/rng.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/run_chains.h"
#include "wearwell/models/joint/archard.h"

namespace wearwell {
namespace {

constexpr int replications = 2000, draws = 1980, thin = 20, ranks = draws / thin + 1, bins = 20;

struct Truth {
  double k, sigma;
};

double measured(ObservationFamily family, double mean, double sd, Rng& rng) {
  if (family == ObservationFamily::normal) return mean + sd * rng.normal();
  const LognormalByMoments<double> law(mean, sd);
  return std::exp(law.eta + law.zeta * rng.normal());
}

// The ranks of k and sigma in one replication.
std::pair<int, int> replicate(ObservationFamily family, const Distribution& k_prior,
                              const Distribution& sigma_prior, int index) {
  Rng rng(20261121, static_cast<std::uint64_t>(index) * 2);
  const Truth truth{quantile(k_prior, rng.uniform()), quantile(sigma_prior, rng.uniform())};
  joint::Inspections inspections;
  for (const double cycles : {100., 1000., 5000., 10000., 20000.}) {
    inspections.work.push_back(cycles * 5.966);
    inspections.volume.push_back(
        measured(family, truth.k * inspections.work.back(), truth.sigma, rng));
  }
  const Unit si{"", 1, 0};
  const Posterior posterior(
      {{"k", "m^3/(N m)", si, "", k_prior, quantile(k_prior, 0.5), 1e-13, 0, INFINITY},
       {"sigma", "m^3", si, "", sigma_prior, quantile(sigma_prior, 0.5), 1e-9, 0, INFINITY}},
      joint::archard_likelihood({}, family, inspections, inspections.work.size()));
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  NutsSettings careful;
  careful.target_accept = 0.95;
  const Draws chains =
      run_nuts(posterior, whitening, careful,
               {1, 1000, draws, 20261121, static_cast<std::uint64_t>(index) * 2 + 1});
  std::pair<int, int> rank{0, 0};
  for (int i = 0; i < draws; i += thin) {
    rank.first += chains[0].values(i, 0) < truth.k;
    rank.second += chains[0].values(i, 1) < truth.sigma;
  }
  return rank;
}

// Pearson's chi-squared of `bins` bins; a correct sampler fails one time in a thousand, and the
// seed is fixed.
void expect_uniform(const std::vector<int>& all, const std::string& what) {
  std::vector<double> count(bins, 0.0);
  for (const int rank : all) count[static_cast<std::size_t>(rank * bins / ranks)] += 1;
  const double expected = static_cast<double>(all.size()) / bins;
  double chi_squared = 0;
  for (const double c : count) chi_squared += (c - expected) * (c - expected) / expected;
  const double p = cdf(complement(boost::math::chi_squared(bins - 1), chi_squared));
  EXPECT_GT(p, 0.001) << what << ": chi-squared " << chi_squared;
}

void calibrate(ObservationFamily family, const Distribution& k_prior,
               const Distribution& sigma_prior) {
  std::vector<int> k(replications), sigma(replications);
  tbb::parallel_for(0, replications, [&](int i) {
    std::tie(k[static_cast<std::size_t>(i)], sigma[static_cast<std::size_t>(i)]) =
        replicate(family, k_prior, sigma_prior, i);
  });
  expect_uniform(k, "k");
  expect_uniform(sigma, "sigma");
}

// 100 ranks fall evenly into 20 bins.
static_assert(ranks % bins == 0);

TEST(JointCalibration, Normal) {
  calibrate(ObservationFamily::normal, make_distribution(Normal{7e-13, 2e-13}, 0, INFINITY),
            make_distribution(Uniform{}, 1e-9, 15e-9));
}

TEST(JointCalibration, Lognormal) {
  calibrate(ObservationFamily::lognormal, make_distribution(Normal{7e-13, 2e-13}, 0, INFINITY),
            make_distribution(Uniform{}, 0.2e-9, 7e-9));
}

TEST(JointCalibration, HalfNormalScatterAndLognormalRate) {
  const LognormalByMoments<double> rate(7e-13, 3e-13);
  calibrate(ObservationFamily::normal,
            make_distribution(Lognormal{std::exp(rate.eta), rate.zeta}, 0, INFINITY),
            make_distribution(Normal{0, 6e-9}, 0, INFINITY));
}

// The test itself must be able to fail: ranks of a sampler that is off by a fifth of a standard
// deviation.
TEST(JointCalibration, NoticesAShift) {
  Rng rng(1, 0);
  std::vector<double> count(bins, 0.0);
  for (int i = 0; i < replications; ++i) {
    const double truth = rng.normal();
    int rank = 0;
    for (int j = 0; j < ranks - 1; ++j) rank += rng.normal() + 0.2 < truth;
    count[static_cast<std::size_t>(rank * bins / ranks)] += 1;
  }
  double chi_squared = 0;
  for (const double c : count)
    chi_squared += std::pow(c - 1.0 * replications / bins, 2) * bins / replications;
  EXPECT_LT(cdf(complement(boost::math::chi_squared(bins - 1), chi_squared)), 0.001);
}

}  // namespace
}  // namespace wearwell
