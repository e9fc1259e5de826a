// The clutch trade at full size: the paper's 900 exact searches, and cycles per second of `wearwell
// clutch predict` from a Parquet file.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>

#include "parquet_file.h"
#include "wearwell/fleet/duckdb_engine.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_predict.h"
#include "wearwell/models/clutch/clutch_study.h"
#include "wearwell/models/clutch/fleet_run.h"
#include "wearwell/models/clutch/wear_map.h"

namespace wearwell::clutch {
namespace {

/// The example, without what the bench does itself.
const ClutchResult& example() {
  static const ClutchResult result = [] {
    ClutchStudy study = read_clutch_study(PROJECT_SOURCE_DIR "/examples/clutch/study.toml");
    study.exponents = {0.5, 1};
    return run_clutch_study(study);
  }();
  return result;
}

// At each of 900 pairs of exponents the best of 2^20 - 1 submodels.
void searches_900(benchmark::State& state) {
  const WearPoints& points = example().points;
  for (auto _ : state) {
    const ExponentSearch search = search_exponents(points, Surrogate::distance, paper_exponents(),
                                                   static_cast<int>(state.range(0)));
    benchmark::DoNotOptimize(search.best);
  }
}
BENCHMARK(searches_900)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);

constexpr long long cycles_per_plate = 50'000;

// Cycles of so many plates, all within the range of validity. Conditions from a multiplicative hash
// of the row: the same in every run.
std::string fleet_of(long long cycles) {
  return fmt::format(
      "select cast(plate as integer) as plate, cycle, s as \"slip_speed [rad/s]\", m as "
      "\"torque [N m]\", t as \"temperature [degC]\", c as \"closing_time [s]\", m*s*c/2 as "
      "\"energy [J]\" from (select i // {0} + 1 as plate, i % {0} + 1 as cycle, "
      "130 + ((i * 2654435761) % 1000003) / 1000003.0 * 160 as s, "
      "26 + ((i * 40503 + 7) % 1000003) / 1000003.0 * 48 as m, "
      "121 + ((i * 69069 + 5) % 1000003) / 1000003.0 * 118 as t, "
      "1 + ((i * 1103515 + 3) % 1000003) / 1000003.0 * 2.3 as c from range({1}) r(i))",
      cycles_per_plate, cycles);
}

void predict(benchmark::State& state, long long cycles, bool with_replicates) {
  const ParquetFile fleet("wearwell-bench-fleet", fleet_of(cycles));
  const WearModel& model = example().model;
  for (auto _ : state) {
    CycleSum sum(model, with_replicates);
    if (sum_cycles(fleet.path(), sum, {}, 1, static_cast<int>(state.range(0))) !=
        static_cast<std::size_t>(cycles))
      state.SkipWithError("cycles are missing");
  }
  state.counters["cycles/s"] = benchmark::Counter(static_cast<double>(cycles),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

// The interval by the scatter of cycles (--scatter-only).
void predict_scatter_only(benchmark::State& state) {
  predict(state, 20'000'000, false);
}
// And by 50 replicates of the whole fit.
void predict_full(benchmark::State& state) {
  predict(state, 2'000'000, true);
}
#define PREDICT(name) \
  BENCHMARK(name)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime()
PREDICT(predict_scatter_only);
PREDICT(predict_full);

// `wearwell fleet` from Parquet on two threads: sums in fixed point, and the report.
void fleet_run(benchmark::State& state, bool with_replicates) {
  const long long cycles = state.range(0);
  const ParquetFile file("wearwell-bench-fleet", fleet_of(cycles));
  const IdentifiedModel model{example().model, "bench"};
  for (auto _ : state) {
    const auto engine = fleet::duckdb_engine({.files = {file.path().string()}, .threads = 2});
    const Result result =
        find_fleet(model, {engine.get()},
                   {.first = true, .replicates = with_replicates, .levels = {25, 50, 75, 100}}, {});
    benchmark::DoNotOptimize(result.header.data.rows);
  }
  state.counters["cycles/s"] = benchmark::Counter(static_cast<double>(cycles),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}
void fleet_scatter_only(benchmark::State& state) {
  fleet_run(state, false);
}
void fleet_full(benchmark::State& state) {
  fleet_run(state, true);
}
// What the engine takes to read the same columns: the limit.
void fleet_scan(benchmark::State& state) {
  const long long cycles = state.range(0);
  const ParquetFile file("wearwell-bench-fleet", fleet_of(cycles));
  for (auto _ : state) {
    const auto engine = fleet::duckdb_engine({.files = {file.path().string()}, .threads = 2});
    engine->rows(
        "select max(plate), max(cycle), sum(columns('speed|torque|temp|time|energy')) from cycles",
        0, [](const fleet::Row& row) { benchmark::DoNotOptimize(row.numbers.front()); });
  }
  state.counters["cycles/s"] = benchmark::Counter(static_cast<double>(cycles),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(fleet_scan)
    ->Arg(20'000'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK(fleet_scatter_only)
    ->Arg(1'000'000)
    ->Arg(20'000'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Iterations(1);
BENCHMARK(fleet_full)
    ->Arg(1'000'000)
    ->Arg(4'000'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Iterations(1);

}  // namespace
}  // namespace wearwell::clutch
