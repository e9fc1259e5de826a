#include "wearwell/models/clutch/run_in.h"

#include <gmock/gmock.h>

#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

using testing::HasSubstr;

const RunIn truth{0.4, 4, 78e6, 6e6};
constexpr double w0 = 20 * mm3_per_MJ;

/// Blocks that wear exactly by the law, on plates with the factors given.
std::vector<WornBlock> exact_blocks(const std::vector<double>& factors) {
  std::vector<WornBlock> blocks;
  for (std::size_t p = 0; p < factors.size(); ++p) {
    double energy = 0;
    for (const double until : {1e6, 3e6, 6e6, 12e6, 24e6, 50e6, 90e6, 150e6, 250e6}) {
      WornBlock block;
      block.plate = static_cast<int>(p) + 1;
      block.block = until < 250e6 ? Block::run_in : Block::run_out;
      block.last = static_cast<std::size_t>((until - energy) / 25e3);
      block.energy_before = energy;
      block.energy = until - energy;
      block.w = factors[p] * w0 * truth.mean(energy, until);
      block.volume = block.w * block.energy;
      block.balance_sd = 1e-12 * w0;
      blocks.push_back(block);
      energy = until;
    }
  }
  return blocks;
}

TEST(RunIn, MeanIsTheIntegralOfG) {
  EXPECT_DOUBLE_EQ(truth.g(0), 5.4);
  EXPECT_NEAR(truth.g(6e6), 1 + 0.4 * std::exp(-6.0 / 78) + 4 * std::exp(-1.0), 1e-14);
  double sum = 0;
  constexpr int steps = 200'000;
  for (int i = 0; i < steps; ++i) sum += truth.g(2e6 + 30e6 * (i + 0.5) / steps) / steps;
  EXPECT_NEAR(truth.mean(2e6, 32e6), sum, 1e-9);
  EXPECT_EQ(truth.mean(3e6, 3e6), truth.g(3e6));
  EXPECT_GE(truth.g(1e12), 1);
}

TEST(RunIn, ExactBlocksGiveTheTruth) {
  const std::vector<double> factors = {1.1, 0.9, 1.3, 0.7};
  double mean_log = 0;
  for (const double f : factors) mean_log += std::log(f) / 4;
  const RunInFit fit = fit_run_in(exact_blocks(factors));
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.blocks, 36u);
  EXPECT_NEAR(fit.parameters[0] / (w0 * std::exp(mean_log)), 1, 1e-6);
  EXPECT_NEAR(fit.run_in.slow / truth.slow, 1, 1e-5);
  EXPECT_NEAR(fit.run_in.fast / truth.fast, 1, 1e-5);
  EXPECT_NEAR(fit.run_in.slow_energy / truth.slow_energy, 1, 1e-5);
  EXPECT_NEAR(fit.run_in.fast_energy / truth.fast_energy, 1, 1e-5);
  double sum = 0;
  for (std::size_t p = 0; p < 4; ++p) {
    EXPECT_NEAR(fit.plates[p].log_factor, std::log(factors[p]) - mean_log, 1e-6);
    EXPECT_NEAR(fit.plates[p].shrunk, fit.plates[p].log_factor, 1e-6)
        << "factors that are known are not shrunk";
    sum += fit.plates[p].log_factor;
  }
  EXPECT_NEAR(sum, 0, 1e-12);
}

// Simulated campaigns, constants (of the energies, logarithms) and plate factors within standard
// errors. The geometric mean of
// the plates' true factors belongs to w0.
TEST(RunIn, RecoversSimulatedTruth) {
  const Truth t = paper_like_truth();
  const std::vector<DesignPoint> design = plan(paper_design());
  double squares = 0;
  int count = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    Truth quick = t;
    quick.worn_out = 1e-7;
    quick.sequence_weighings = 1;
    const Simulation simulation = simulate(design, quick, seed);
    const RunInFit fit = fit_run_in(worn_blocks(simulation.campaign).blocks);
    EXPECT_TRUE(fit.converged);
    double mean_log = 0;
    for (int p = 0; p < t.plates; ++p)
      mean_log += std::log(simulation.plate_factors[static_cast<std::size_t>(p)]) / t.plates;
    const double settled = t.w(t.run_in_point) * std::exp(mean_log);
    const double expected[] = {settled, t.run_in.slow * settled, t.run_in.fast * settled,
                               t.run_in.slow_energy, t.run_in.fast_energy};
    for (int i = 0; i < RunInFit::size; ++i) {
      const double sd = std::sqrt(fit.covariance(i, i)), value = fit.parameters[i];
      const double z =
          i < 3 ? (value - expected[i]) / sd : std::log(value / expected[i]) * value / sd;
      EXPECT_LT(std::abs(z), 3) << "seed " << seed << ", parameter " << i;
    }
    ASSERT_EQ(fit.plates.size(), 13u);
    for (std::size_t p = 0; p < 13; ++p) {
      const double error =
          fit.plates[p].log_factor - (std::log(simulation.plate_factors[p]) - mean_log);
      squares += std::pow(error / fit.plates[p].standard_error, 2);
      ++count;
    }
    EXPECT_NEAR(fit.plate_sd, t.plate_sd, 0.04);
  }
  // 104 factors, 12 of each 13 free: chi2 over its freedom within 4 of its standard deviations.
  const double freedom = count * 12.0 / 13;
  EXPECT_NEAR(squares / freedom, 1, 4 * std::sqrt(2 / freedom));
}

// Shrinking loses less than taking the factors as fitted, over many plates.
TEST(RunIn, ShrunkFactorsAreCloser) {
  const Truth t = paper_like_truth();
  Truth quick = t;
  quick.worn_out = 1e-7;
  quick.sequence_weighings = 1;
  double as_fitted = 0, shrunk = 0;
  for (const std::uint64_t seed : {11, 12, 13, 14, 15, 16}) {
    const Simulation simulation = simulate({{1, Role::model, t.run_in_point}}, quick, seed);
    const RunInFit fit = fit_run_in(worn_blocks(simulation.campaign).blocks);
    for (std::size_t p = 0; p < 13; ++p) {
      const double real = std::log(simulation.plate_factors[p]);
      as_fitted += std::pow(fit.plates[p].log_factor - real, 2);
      shrunk += std::pow(fit.plates[p].shrunk - real, 2);
    }
  }
  EXPECT_LT(shrunk, as_fitted);
}

TEST(RunIn, RefusesTooFewBlocks) {
  auto blocks = exact_blocks({1});
  blocks.resize(5);
  EXPECT_THAT(message_of<InputError>([&] { fit_run_in(blocks); }),
              HasSubstr("5 blocks of run-in and run-out on 1 plates are too few for 5 constants"));
  EXPECT_THAT(message_of<InputError>([&] { fit_run_in({}); }), HasSubstr("0 blocks"));
}

}  // namespace
}  // namespace wearwell::clutch
