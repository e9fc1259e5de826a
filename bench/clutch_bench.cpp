// The clutch trade at full size: the paper's 900 exact searches, and cycles per second of `wearwell
// clutch predict` from a Parquet file.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

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

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Processor time a cycle in us, which other work on the machine changes least, and the most memory that the process had in
/// MB: run one benchmark alone for that.
void report(benchmark::State& state, double seconds, long long cycles) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  state.counters["us_a_cycle"] =
      1e6 * seconds / static_cast<double>(cycles) / static_cast<double>(state.iterations());
  state.counters["MB"] = static_cast<double>(used.ru_maxrss) / 1024;
}

enum class Way { scatter_only, full, statements_scatter_only, statements_full };

// `wearwell fleet` from Parquet on two threads: sums in fixed point, and the report.
void run_fleet(benchmark::State& state, const std::string& query, Way way) {
  const long long cycles = state.range(0);
  const ParquetFile file("wearwell-bench-fleet", query);
  const IdentifiedModel model{example().model, "bench"};
  const double start = processor_seconds();
  for (auto _ : state) {
    const auto engine =
        fleet::duckdb_engine({.files = {file.path().string()}, .threads = 2, .memory = 1000});
    const Result result = find_fleet(
        model, {engine.get()},
        {.first = true,
         .replicates = way == Way::full || way == Way::statements_full,
         .statements = way == Way::statements_full || way == Way::statements_scatter_only,
         .levels = {25, 50, 75, 100}},
        {.threads = 2});
    benchmark::DoNotOptimize(result.header.data.rows);
  }
  report(state, processor_seconds() - start, cycles);
}
void fleet_in_order(benchmark::State& state, Way way) {
  run_fleet(state, fleet_of(state.range(0)), way);
}
// Row after row of another unit, as time brings them.
void fleet_by_time(benchmark::State& state) {
  run_fleet(state, fleet_of(state.range(0)) + " order by cycle, plate", Way::full);
}
void fleet_in_no_order(benchmark::State& state) {
  run_fleet(state, fleet_of(state.range(0)) + " order by hash(plate * 7919 + cycle)", Way::full);
}
// What the engine takes to read the same columns: the limit.
void fleet_scan(benchmark::State& state) {
  const long long cycles = state.range(0);
  const ParquetFile file("wearwell-bench-fleet", fleet_of(cycles));
  const double start = processor_seconds();
  for (auto _ : state) {
    const auto engine = fleet::duckdb_engine({.files = {file.path().string()}, .threads = 2});
    engine->rows(
        "select max(plate), max(cycle), sum(columns('speed|torque|temp|time|energy')) from cycles",
        0, [](const fleet::Row& row) { benchmark::DoNotOptimize(row.numbers.front()); });
  }
  report(state, processor_seconds() - start, cycles);
}
#define FLEET(name, ...)               \
  BENCHMARK_CAPTURE(name, __VA_ARGS__) \
      ->Unit(benchmark::kMillisecond)  \
      ->UseRealTime()                  \
      ->MeasureProcessCPUTime()        \
      ->Iterations(1)
constexpr long long million = 1'000'000;
BENCHMARK(fleet_scan)
    ->Arg(10 * million)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
FLEET(fleet_in_order, scatter_only, Way::scatter_only)
    ->Arg(million)
    ->Arg(10 * million)
    ->Arg(100 * million);
FLEET(fleet_in_order, full, Way::full)->Arg(million)->Arg(10 * million)->Arg(100 * million);
FLEET(fleet_in_order, statements_scatter_only, Way::statements_scatter_only)->Arg(10 * million);
FLEET(fleet_in_order, statements_full, Way::statements_full)->Arg(million);
// A large fleet, as a manufacturer's would write it: readings of 12 bits, energy in J, files of 10^8 cycles of their own units,
// 13.5 bytes a cycle on disk. In the temporary folder (TMPDIR), gone at the end.
void large_fleet(benchmark::State& state, Way way) {
  const long long cycles = state.range(0), part = std::min(cycles, 100 * million);
  if (!std::getenv("WEARWELL_BENCH_LARGE")) {
    state.SkipWithError("WEARWELL_BENCH_LARGE=1 runs it: half an hour, 15 GB of disk");
    return;
  }
  std::vector<std::unique_ptr<ParquetFile>> files;
  std::vector<std::string> names;
  double bytes = 0;
  for (long long from = 0; from < cycles; from += part) {
    files.push_back(std::make_unique<ParquetFile>(
        fmt::format("wearwell-bench-large-{}", files.size()),
        fmt::format(
            "select plate, cycle, s as \"slip_speed [rad/s]\", m as \"torque [N m]\", t as "
            "\"temperature [degC]\", c as \"closing_time [s]\", cast(m*s*c/2 as integer) as "
            "\"energy [J]\" from (select cast(i // {0} + 1 as integer) as plate, "
            "cast(i % {0} + 1 as integer) as cycle, 130 + ((i * 40503 + 1) % 4093) / 25.6 as s, "
            "26 + ((i * 69069 + 7) % 4091) / 85.25 as m, 121 + ((i * 1103515 + 5) % 4079) / "
            "34.7 as t, 1 + ((i * 25173 + 3) % 4073) / 1780.0 as c from range({1}, {2}) r(i))",
            cycles_per_plate, from, std::min(cycles, from + part))));
    names.push_back(files.back()->path().string());
    bytes += static_cast<double>(std::filesystem::file_size(files.back()->path()));
  }
  const IdentifiedModel model{example().model, "bench"};
  std::ofstream("/proc/self/clear_refs") << 5;  // what writing took is no part of the most memory
  const double start = processor_seconds();
  for (auto _ : state) {
    const auto engine = fleet::duckdb_engine({.files = names, .threads = 2, .memory = 1000});
    const Result result =
        find_fleet(model, {engine.get()},
                   {.first = true, .replicates = way == Way::full, .levels = {25, 50, 75, 100}},
                   {.threads = 2});
    if (result.header.data.rows != static_cast<std::size_t>(cycles))
      state.SkipWithError("cycles are missing");
  }
  report(state, processor_seconds() - start, cycles);
  state.counters["bytes_a_cycle"] = bytes / static_cast<double>(cycles);
}
FLEET(large_fleet, scatter_only, Way::scatter_only)->Arg(100 * million)->Arg(1000 * million);
FLEET(large_fleet, full, Way::full)->Arg(100 * million)->Arg(1000 * million);
BENCHMARK(fleet_by_time)->Arg(10 * million)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(fleet_in_no_order)->Arg(10 * million)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace wearwell::clutch
