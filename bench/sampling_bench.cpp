// Effective draws per second: of k on the joint posterior of examples/joint/study.toml, and of the
// parameter with the fewest on case 2 of examples/spring, a narrow ridge cut by bounds. The peers
// are peers/joint.R and peers/spring.R.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "support/posterior_study.h"
#include "wearwell/infer/diagnostics.h"
#include "wearwell/infer/exact.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/run_chains.h"

namespace wearwell {
namespace {

Posterior posterior_of(const std::string& example) {
  const PosteriorStudy study = read_posterior_study(PROJECT_SOURCE_DIR "/examples/" + example);
  return {study.parameters, study.likelihood(study.data_rows)};
}

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// 4 chains of 1000 draws after 1000 of warm-up. Sampling alone is the time of the whole less that
// of warm-up with 10 draws. Counts the effective draws of the first `counted` parameters.
void nuts(benchmark::State& state, const std::string& example, int counted) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(0)));
  NutsSettings settings;
  settings.target_accept = 0.01 * static_cast<double>(state.range(1));
  const Posterior posterior = posterior_of(example);
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
    for (int i = 0; i < counted; ++i) fewest = std::min(fewest, ess_bulk(chains_of(draws, i)));
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
BENCHMARK_CAPTURE(nuts, joint, "joint/study.toml", 1)
    ->ArgNames({"threads", "target_accept_%"})
    ->Args({1, 80})
    ->Args({2, 80})
    ->Args({1, 90})
    ->Args({2, 90})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(nuts, spring, "spring/case2.toml", 4)
    ->ArgNames({"threads", "target_accept_%"})
    ->Args({1, 80})
    ->Args({1, 90})
    ->Args({1, 99})
    ->Args({2, 90})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void exact(benchmark::State& state, const std::string& example) {
  const Posterior posterior = posterior_of(example);
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  for (auto _ : state) benchmark::DoNotOptimize(integrate(posterior, whitening));
}
BENCHMARK_CAPTURE(exact, joint, "joint/study.toml")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(exact, spring, "spring/case2.toml")->Unit(benchmark::kMillisecond)->UseRealTime();

void gradient(benchmark::State& state, const std::string& example) {
  const Posterior posterior = posterior_of(example);
  const auto d = static_cast<std::size_t>(posterior.dimension());
  const std::vector<double> z(d, 0.1);
  std::vector<double> slope(d);
  for (auto _ : state) {
    benchmark::DoNotOptimize(posterior.value_and_gradient(z, slope));
    benchmark::ClobberMemory();
  }
}
BENCHMARK_CAPTURE(gradient, joint, "joint/study.toml");
BENCHMARK_CAPTURE(gradient, spring, "spring/case2.toml");

}  // namespace
}  // namespace wearwell
