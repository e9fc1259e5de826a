// Rainflow counting of 20 million samples from a Parquet file, on one thread beside those of DuckDB: a
// narrow-band signal, as a vibrating part has, and white noise, in which every other sample turns.
#include <benchmark/benchmark.h>
#include <duckdb.h>
#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "wearwell/models/fatigue/load_history.h"
#include "wearwell/models/fatigue/signal_file.h"

namespace wearwell::fatigue {
namespace {

constexpr long long samples = 20'000'000;

/// A column of samples as Parquet in the temporary folder.
class Recording {
 public:
  explicit Recording(const std::string& expression)
      : file_(std::filesystem::temp_directory_path() / "wearwell-bench-rainflow.parquet") {
    duckdb_database database = nullptr;
    duckdb_connection connection = nullptr;
    if (duckdb_open(nullptr, &database) != DuckDBSuccess ||
        duckdb_connect(database, &connection) != DuckDBSuccess)
      throw std::runtime_error("cannot start DuckDB");
    const std::string query = fmt::format(
        "copy (select {} as \"stress [MPa]\" from range({}) r(i)) to '{}' (format "
        "parquet)",
        expression, samples, file_.string());
    const bool done = duckdb_query(connection, query.c_str(), nullptr) == DuckDBSuccess;
    duckdb_disconnect(&connection);
    duckdb_close(&database);
    if (!done) throw std::runtime_error("cannot write " + file_.string());
  }
  ~Recording() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

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
  const Recording recording(signal);
  for (auto _ : state) {
    LoadHistory history(CountingRule{});
    const std::size_t read = read_all(recording.file(), counted ? &history : nullptr);
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
