#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "wearwell/base/rng.h"
#include "wearwell/infer/diagnostics.h"
#include "wearwell/infer/power_scaling.h"

namespace wearwell {
namespace {

/// Chains of an AR(1) process.
std::vector<std::vector<double>> autoregressive(std::size_t chains, std::size_t draws, double rho,
                                                std::uint64_t seed) {
  std::vector<std::vector<double>> values(chains, std::vector<double>(draws));
  for (std::size_t c = 0; c < chains; ++c) {
    Rng rng(seed, c);
    double x = rng.normal();
    for (double& value : values[c]) {
      value = x;
      x = rho * x + std::sqrt(1 - rho * rho) * rng.normal();
    }
  }
  return values;
}

void Diagnose(benchmark::State& state) {
  const auto draws = static_cast<std::size_t>(state.range(0));
  const double rho = static_cast<double>(state.range(1)) / 100;
  // Many quantities in turn: the processor learns the branches of sorting a single one by heart.
  std::vector<std::vector<std::vector<double>>> values;
  std::vector<Chains> quantities(64);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    values.push_back(autoregressive(4, draws, rho, i));
    for (const auto& chain : values[i]) quantities[i].draws.push_back(chain);
  }
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(diagnose(quantities[i++ % quantities.size()]));
}
BENCHMARK(Diagnose)
    ->ArgNames({"draws", "rho_percent"})
    ->ArgsProduct({{1000, 10000}, {0, 50, 95}})
    ->Unit(benchmark::kMicrosecond);

void PowerScale(benchmark::State& state) {
  Rng rng(1, 0);
  std::vector<double> draws(4000), log_prior(4000), log_likelihood(4000);
  for (std::size_t i = 0; i < draws.size(); ++i) {
    draws[i] = rng.normal();
    log_prior[i] = -0.5 * (draws[i] - 1) * (draws[i] - 1);
    log_likelihood[i] = -0.5 * (draws[i] + 1) * (draws[i] + 1);
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(power_scaling(draws, log_prior, log_likelihood));
  }
}
BENCHMARK(PowerScale)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace wearwell
