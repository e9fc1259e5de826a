// Effective draws of k per second on the joint posterior of examples/joint/study.toml; the peer is
// peers/joint.R.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <chrono>

#include "wearwell/infer/diagnostics.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/run_chains.h"
#include "wearwell/joint/archard.h"

namespace wearwell {
namespace {

Posterior joint() {
  joint::Inspections inspections;
  for (const double cycles : {1., 100., 1000., 5000., 10000.})
    inspections.work.push_back(cycles * 5.966);
  for (const double volume : {4.44, 5.105, 8.825, 24.175, 45.31})
    inspections.volume.push_back(volume * 1e-9);
  const Unit si{"1", 1, 0};
  return Posterior(
      {{"k", "m^3/(N m)", si, "flat", make_law(Flat{}, 0, INFINITY), 7e-13, 7e-13, 0, INFINITY},
       {"sigma", "m^3", si, "uniform", make_law(Uniform{}, 0, 15e-9), 3e-9, 3e-9, 0, INFINITY}},
      joint::archard_likelihood({}, ObservationFamily::normal, inspections, 5));
}

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// 4 chains of 1000 draws after 1000 of warm-up. Sampling alone is the time of the whole less that
// of warm-up with 10 draws.
void nuts(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(0)));
  NutsSettings settings;
  settings.target_accept = 0.01 * static_cast<double>(state.range(1));
  const Posterior posterior = joint();
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  double effective = 0, whole = 0, warmup = 0;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    ++seed;
    Draws draws;
    whole += seconds_of([&] {
      draws = run_nuts(posterior, whitening, settings, {4, 1000, 1000, seed, 0});
    });
    state.PauseTiming();
    warmup += seconds_of([&] { run_nuts(posterior, whitening, settings, {4, 1000, 10, seed, 0}); });
    effective += ess_bulk(chains_of(draws, 0));
    state.ResumeTiming();
  }
  state.counters["effective_draws"] = effective / static_cast<double>(seed);
  state.counters["per_second_of_sampling"] = effective / (whole - warmup);
  state.counters["per_second_with_warmup"] = effective / whole;
}
BENCHMARK(nuts)
    ->ArgNames({"threads", "target_accept_%"})
    ->Args({1, 80})
    ->Args({2, 80})
    ->Args({1, 90})
    ->Args({2, 90})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void exact(benchmark::State& state) {
  const Posterior posterior = joint();
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  for (auto _ : state) benchmark::DoNotOptimize(integrate(posterior, whitening));
}
BENCHMARK(exact)->Unit(benchmark::kMillisecond);

void gradient(benchmark::State& state) {
  const Posterior posterior = joint();
  Eigen::Vector2d z(0.1, 0.2), slope;
  for (auto _ : state) {
    benchmark::DoNotOptimize(posterior.value_and_gradient({z.data(), 2}, {slope.data(), 2}));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(gradient);

}  // namespace
}  // namespace wearwell
