// Effective draws per second on case 2 of examples/spring, a narrow ridge cut by bounds, of the
// parameter with the fewest; the peer is peers/spring.R.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>

#include "wearwell/infer/fit.h"
#include "wearwell/infer/mode.h"
#include "wearwell/study/study.h"

namespace wearwell {
namespace {

Posterior spring() {
  const Study study = read_study(PROJECT_SOURCE_DIR "/examples/spring/case2.toml");
  return {study.parameters, study.likelihood(study.data_rows)};
}

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// 4 chains of 1000 draws after 1000 of warm-up. Sampling alone is the time of the whole less that
// of warm-up with 10 draws.
void spring_nuts(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(0)));
  NutsSettings settings;
  settings.target_accept = 0.01 * static_cast<double>(state.range(1));
  const Posterior posterior = spring();
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  double effective = 0, whole = 0, warmup = 0, divergent = 0;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    ++seed;
    Draws draws;
    whole += seconds_of([&] {
      draws = run_nuts(posterior, whitening, settings, {4, 1000, 1000, seed, 0});
    });
    state.PauseTiming();
    warmup += seconds_of([&] { run_nuts(posterior, whitening, settings, {4, 1000, 10, seed, 0}); });
    double fewest = INFINITY;
    for (int i = 0; i < posterior.dimension(); ++i) {
      fewest = std::min(fewest, ess_bulk(chains_of(draws, i)));
    }
    effective += fewest;
    for (const Chain& chain : draws) {
      for (const NutsStep& step : chain.nuts) divergent += step.divergent;
    }
    state.ResumeTiming();
  }
  const auto runs = static_cast<double>(seed);
  state.counters["effective_draws"] = effective / runs;
  state.counters["per_second_of_sampling"] = effective / (whole - warmup);
  state.counters["per_second_with_warmup"] = effective / whole;
  state.counters["divergent"] = divergent / runs;
}
BENCHMARK(spring_nuts)
    ->ArgNames({"threads", "target_accept_%"})
    ->Args({1, 80})
    ->Args({1, 90})
    ->Args({1, 99})
    ->Args({2, 90})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void spring_exact(benchmark::State& state) {
  const Posterior posterior = spring();
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  for (auto _ : state) benchmark::DoNotOptimize(integrate(posterior, whitening));
}
BENCHMARK(spring_exact)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace wearwell
