// Rainflow counting of 20 million samples from a Parquet file, on one thread beside those of DuckDB: a
// narrow-band signal, as a vibrating part has, and white noise, in which every other sample turns.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <filesystem>

#include "parquet_file.h"
#include "wearwell/models/fatigue/load_history.h"
#include "wearwell/models/fatigue/signal_file.h"

namespace wearwell::fatigue {
namespace {

constexpr long long samples = 20'000'000;

// Two hashes of the row make a standard normal number: the same in every run.
constexpr const char* noise =
    "sqrt(-2*ln(((i * 2654435761 + 12345) % 1000003 + 1) / 1000004.0)) * "
    "cos(6.283185307179586 * ((i * 40503 + 7) % 1000033) / 1000033.0) * 50";
constexpr const char* narrow_band =
    "sin(i * 0.35) * (60 + 40 * sin(i * 0.000731)) + 20 * sin(i * 0.0123)";

std::size_t read_all(const std::filesystem::path& file, LoadHistory* history) {
  SignalFile signal({file});
  std::size_t count = 0;
  for (auto piece = signal.next(); !piece.empty(); piece = signal.next()) {
    count += piece.size();
    if (history) history->add(piece);
  }
  return count;
}

void count(benchmark::State& state, const char* signal, bool counted) {
  const ParquetFile recording(
      "wearwell-bench-rainflow",
      fmt::format("select {} as \"stress [MPa]\" from range({}) r(i)", signal, samples));
  for (auto _ : state) {
    LoadHistory history(CountingRule{});
    const std::size_t read = read_all(recording.path(), counted ? &history : nullptr);
    if (read != static_cast<std::size_t>(samples)) state.SkipWithError("samples are missing");
    if (counted) benchmark::DoNotOptimize(history.counted());
  }
  state.counters["samples/s"] = benchmark::Counter(static_cast<double>(samples),
                                                   benchmark::Counter::kIsIterationInvariantRate);
}

void read_alone(benchmark::State& state) {
  count(state, narrow_band, false);
}
void count_narrow_band(benchmark::State& state) {
  count(state, narrow_band, true);
}
void count_white_noise(benchmark::State& state) {
  count(state, noise, true);
}
BENCHMARK(read_alone)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(count_narrow_band)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(count_white_noise)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace wearwell::fatigue
