// Simulation-based calibration of the bearing study (Talts et al. 2018, arXiv:1804.06788): truths
// drawn from the prior, data simulated from them, the rank of each truth among the posterior's
// draws is even.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/mode.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/models/bearing/wear_number.h"

namespace wearwell::bearing {
namespace {

constexpr double median_k = 2e-15, log_sd_k = 0.5, sd_scatter = 0.4, depth_error = 2e-6;

std::vector<Parameter> parameters() {
  const Unit si{"1", 1, 0};
  Parameter k{"k", "m^3/(N m)", si, "lognormal",
              make_distribution(Lognormal{median_k, log_sd_k}, 0, INFINITY)};
  k.start = median_k;
  k.scale = median_k;
  Parameter scatter{"k_scatter", "1", si, "half-normal",
                    make_distribution(Normal{0, sd_scatter}, 0, INFINITY)};
  scatter.start = scatter.scale = 0.3;
  return {k, scatter};
}

// Six bearings, two inspections each, simulated with the inverse geometry itself.
Inspections simulate(double k, double k_scatter, Rng& rng) {
  Inspections data;
  for (std::size_t b = 0; b < 6; ++b) {
    const double k_b = k * std::exp(k_scatter * rng.normal());
    for (const double n : {1e5, 2e5}) {
      const Duty duty{b < 4 ? Contact::stationary : Contact::bushing, 0.01, 3e-5, 1e6, n};
      const double delta =
          depth_for(duty.contact, duty.clearance / duty.radius, k_b * duty.pressure * n);
      data.duty.push_back(duty);
      data.depth.push_back(duty.radius * delta + depth_error * rng.normal());
      data.bearing.push_back(b);
    }
  }
  return data;
}

// The rank in infinitely many draws: the exact posterior's cdf at the truth.
TEST(BearingCalibration, RanksAreEven) {
  constexpr int runs = 300, bins = 10;
  const WearModel model{ObservationFamily::normal, depth_error, true};
  std::array<std::array<int, bins>, 2> counts{};
  for (int run = 0; run < runs; ++run) {
    Rng rng(11, static_cast<std::uint64_t>(run));
    const double truth[] = {median_k * std::exp(log_sd_k * rng.normal()),
                            sd_scatter * std::abs(rng.normal())};
    const Inspections data = simulate(truth[0], truth[1], rng);
    const Posterior posterior(parameters(), wear_likelihood(model, data, data.depth.size()));
    const ExactPosterior exact =
        integrate(posterior, whitening_at(find_mode(posterior, posterior.start())));
    ASSERT_EQ(exact.failure, "") << run;
    for (std::size_t p = 0; p < 2; ++p) {
      const double below =
          QuantityDistribution(exact.nodes, [p](const double* x) { return x[p]; }).cdf(truth[p]);
      ++counts[p][static_cast<std::size_t>(std::min(bins - 1.0, bins * below))];
    }
  }
  for (std::size_t p = 0; p < 2; ++p) {
    double chi2 = 0;
    for (const int count : counts[p]) {
      chi2 += std::pow(count - runs / bins, 2) / (runs / bins);
    }
    EXPECT_LT(chi2, 27.9) << "parameter " << p;  // R: qchisq(0.999, 9) = 27.88
  }
}

}  // namespace
}  // namespace wearwell::bearing
