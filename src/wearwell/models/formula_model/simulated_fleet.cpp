#include "wearwell/models/formula_model/simulated_fleet.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

#include "wearwell/base/rng.h"

namespace wearwell::formula_model {
namespace {

constexpr std::int64_t begin = 1767600000;  // 2026-01-05 08:00 UTC, a Monday
constexpr std::int64_t hour = 3600, week = 168 * hour;
constexpr int weeks = 52;

SimulatedMachine machine(std::string name, Rng& rng) {
  const double rate = median_rate * std::exp(rate_scatter * rng.normal());
  return {std::move(name), rate, wear_limit / rate};
}

double rounded(double x, double to) {
  return std::round(x / to) * to;
}

std::string time_text(std::int64_t time) {
  using namespace std::chrono;
  const sys_seconds at{seconds(time)};
  const auto day = floor<days>(at);
  const year_month_day date{day};
  const hh_mm_ss clock{at - day};
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

// One machine's year: a weekly reading at its use by then.
void report(std::size_t index, const SimulatedMachine& one, Rng& rng,
            std::vector<std::pair<std::int64_t, SimulatedReading>>& arrivals) {
  const auto first = static_cast<std::int64_t>(rng.uniform() * 26 * static_cast<double>(week));
  const double share = rng.uniform(0.6, 0.95);  // the share of a week that it runs
  double use = 0;
  for (std::int64_t time = begin + first; time < begin + weeks * week; time += week) {
    use += 168 * share * rng.uniform(0.8, 1.2);
    const double wear = one.rate * use + reading_error * rng.normal();
    const double luck = rng.uniform();
    if (use >= one.life) return;
    if (luck < 0.02) continue;  // lost
    const std::int64_t read = time + static_cast<std::int64_t>(rng.uniform() * 8 * hour);
    const SimulatedReading reading{index, read, rounded(use, 0.1), rounded(wear, 0.01)};
    arrivals.emplace_back(luck < 0.05 ? read + 9 * 24 * hour : read, reading);  // some late
    if (luck > 0.98) arrivals.emplace_back(read + hour, reading);               // some twice
  }
}

}  // namespace

SimulatedFleet simulate_fleet(std::uint64_t seed, std::size_t count) {
  SimulatedFleet fleet;
  Rng learned(seed, 0);
  for (std::size_t i = 0; i < 5; ++i) {
    fleet.learned.push_back(machine(fmt::format("L{}", i + 1), learned));
    double use = 0;
    for (int k = 0; k < 8; ++k) {
      use += learned.uniform(300, 600);
      const double wear = fleet.learned[i].rate * use + reading_error * learned.normal();
      if (use < fleet.learned[i].life)
        fleet.learned_readings.push_back({i, 0, rounded(use, 1), rounded(wear, 0.01)});
    }
  }
  std::vector<std::pair<std::int64_t, SimulatedReading>> arrivals;
  for (std::size_t i = 0; i < count; ++i) {
    Rng rng(seed, i + 1);
    fleet.machines.push_back(machine(fmt::format("M{:03}", i + 1), rng));
    report(i, fleet.machines[i], rng, arrivals);
  }
  std::stable_sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first, a.second.machine) < std::tie(b.first, b.second.machine);
  });
  for (const auto& [_, reading] : arrivals) fleet.readings.push_back(reading);
  return fleet;
}

std::string learned_csv(const SimulatedFleet& fleet) {
  std::string out = "machine,use_h,wear_um\n";
  for (const SimulatedReading& each : fleet.learned_readings)
    out += fmt::format("{},{:.0f},{:.2f}\n", fleet.learned[each.machine].name, each.use, each.wear);
  return out;
}

std::string readings_jsonl(const SimulatedFleet& fleet) {
  std::string out;
  for (const SimulatedReading& each : fleet.readings)
    out +=
        fmt::format(R"({{"time":"{}","machine":"{}","use_h":{:.1f},"wear_um":{:.2f}}})"
                    "\n",
                    time_text(each.time), fleet.machines[each.machine].name, each.use, each.wear);
  return out;
}

std::string truth_csv(const SimulatedFleet& fleet) {
  std::string out = "machine,rate [um/h],life [h]\n";
  for (const SimulatedMachine& each : fleet.machines)
    out += fmt::format("{},{:.6f},{:.1f}\n", each.name, each.rate, each.life);
  return out;
}

}  // namespace wearwell::formula_model
