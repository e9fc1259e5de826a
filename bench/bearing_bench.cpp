// How many wear numbers, and how many depths back from them, one core does in a second.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "wearwell/base/rng.h"
#include "wearwell/models/bearing/wear_number.h"

namespace wearwell::bearing {
namespace {

struct Point {
  double sigma, delta, wear_number;
};

/// Clearances of 1e-4 to 1e-2 and depths of 1e-6 to 0.1 journal radii, even in the logarithm.
std::array<Point, 4096> points(Contact contact) {
  std::array<Point, 4096> result;
  Rng rng(1, 0);
  for (Point& p : result) {
    p.sigma = std::pow(10, rng.uniform(-4, -2));
    p.delta = std::pow(10, rng.uniform(-6, -1));
    p.wear_number = wear_number(contact, p.sigma, p.delta);
  }
  return result;
}

void forward(benchmark::State& state, Contact contact) {
  const auto at = points(contact);
  std::size_t i = 0;
  for (auto _ : state) {
    const Point& p = at[i++ % at.size()];
    benchmark::DoNotOptimize(wear_number(contact, p.sigma, p.delta));
  }
  state.SetItemsProcessed(state.iterations());
}

void inverse(benchmark::State& state, Contact contact) {
  const auto at = points(contact);
  std::size_t i = 0;
  for (auto _ : state) {
    const Point& p = at[i++ % at.size()];
    benchmark::DoNotOptimize(depth_for(contact, p.sigma, p.wear_number));
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(forward, stationary, Contact::stationary);
BENCHMARK_CAPTURE(forward, bushing, Contact::bushing);
BENCHMARK_CAPTURE(inverse, stationary, Contact::stationary);
BENCHMARK_CAPTURE(inverse, bushing, Contact::bushing);

}  // namespace
}  // namespace wearwell::bearing
