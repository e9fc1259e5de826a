// One unit on line: a reading taken, beside the fit that would be done instead; a forecast; a state saved and read.
// The law is that of examples/formula: depth = k * work / area, k of each machine lognormal, readings normal.
#include <benchmark/benchmark.h>

#include <cmath>

#include "calibration/formula_design.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/formula_model/formula_tracker.h"

namespace wearwell::formula_model {
namespace {

constexpr double um = 1e-6, km = 1000;

prognosis::CarriedState state_of_example() {
  prognosis::CarriedState state;
  state.source = source_of(PROJECT_SOURCE_DIR "/examples/formula/study.toml");
  const TomlReader root = TomlReader::parse(state.source.study);
  const auto model = read_formula_model(root, state.source);
  for (const Parameter& each : model->parameters) state.parameters.push_back(each.name);
  state.posterior =
      exact_posterior(std::make_shared<const FormulaRows>(model, model->data.table.rows), 1e-5)
          .nodes;
  return state;
}

const prognosis::Tracker& tracker() {
  static const auto one = track_units(state_of_example());
  return *one;
}

// force = 20 N, every half kilometre.
std::vector<prognosis::Reading> readings(std::size_t count) {
  std::vector<prognosis::Reading> all;
  Rng rng(5, 0);
  for (std::size_t i = 1; i <= count; ++i) {
    const double distance = 0.5 * km * static_cast<double>(i);
    prognosis::Reading reading;
    for (const auto& column : tracker().columns()) {
      reading.numbers.push_back(column.name == "force" ? 20
                                : column.name == "distance"
                                    ? distance
                                    : 0.8e-9 * distance + 1.2 * um * rng.normal());
    }
    all.push_back(reading);
  }
  return all;
}

void take(benchmark::State& state) {
  const auto all = readings(static_cast<std::size_t>(state.range(0)));
  std::size_t taken = 0;
  for (auto _ : state) {
    const auto unit = tracker().begin("new");
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto result = unit->update(all[i], [&](const auto& visit) {
        for (std::size_t k = 0; k < i; ++k) visit(all[k]);
      });
      benchmark::DoNotOptimize(result.counted);
    }
    taken += all.size();
    state.counters["state_bytes"] = static_cast<double>(unit->save().size());
  }
  state.counters["us_a_reading"] = benchmark::Counter(
      static_cast<double>(taken) * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(take)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

// A reading that lays no nodes anew.
void multiply(benchmark::State& state) {
  const auto all = readings(60);
  const auto unit = tracker().begin("new");
  for (std::size_t i = 0; i < 59; ++i) {
    unit->update(all[i], [&](const auto& visit) {
      for (std::size_t k = 0; k < i; ++k) visit(all[k]);
    });
  }
  const std::string bytes = unit->save();
  std::vector<std::unique_ptr<prognosis::TrackedUnit>> units;
  for (auto _ : state) {
    state.PauseTiming();
    if (units.empty()) {
      for (int i = 0; i < 100; ++i) units.push_back(tracker().restore(bytes));
    }
    state.ResumeTiming();
    benchmark::DoNotOptimize(units.back()->update(all.back(), [](const auto&) {}));
    state.PauseTiming();
    units.pop_back();
    state.ResumeTiming();
  }
}
BENCHMARK(multiply)->Unit(benchmark::kMicrosecond);

void forecast(benchmark::State& state) {
  const auto all = readings(10);
  const auto unit = tracker().begin("new");
  for (std::size_t i = 0; i < all.size(); ++i) {
    unit->update(all[i], [&](const auto& visit) {
      for (std::size_t k = 0; k < i; ++k) visit(all[k]);
    });
  }
  for (auto _ : state) benchmark::DoNotOptimize(unit->forecast());
}
BENCHMARK(forecast)->Unit(benchmark::kMicrosecond);

void path_ahead(benchmark::State& state) {
  const auto unit = tracker().begin("new");
  const std::vector<double> places = prognosis::places_ahead(unit->forecast());
  for (auto _ : state) benchmark::DoNotOptimize(unit->ahead(places));
}
BENCHMARK(path_ahead)->Unit(benchmark::kMicrosecond);

void save_and_restore(benchmark::State& state) {
  const std::string bytes = tracker().begin("new")->save();
  for (auto _ : state) benchmark::DoNotOptimize(tracker().restore(bytes)->save());
}
BENCHMARK(save_and_restore)->Unit(benchmark::kMicrosecond);

// What the same costs as a fit of all rows anew, without any prediction.
void refit(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(state_of_example().posterior.weights.size());
}
BENCHMARK(refit)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace wearwell::formula_model
