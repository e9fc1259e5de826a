// So many units that report so often for so long: what is stored, how long it takes to be stored, and how long until the
// state that people see knows of it; then what it holds in memory and on disk, and how long a restart takes.
//
//   build/release/bin/monitor_load RESULT [UNITS 1000] [A_SECOND 10] [SECONDS 60] [STORE load.sqlite]
//
// RESULT: wearwell fit examples/formula/study.toml -o RESULT. With 0 a second nothing is sent: a restart on STORE.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <thread>

#include "wearwell/base/rng.h"
#include "wearwell/models/registry.h"
#include "wearwell/monitor/fleet.h"
#include "wearwell/monitor/intake.h"
#include "wearwell/monitor/monitor_run.h"
#include "wearwell/prognosis/carried_state.h"

namespace {

using namespace wearwell;
using namespace wearwell::monitor;
using Clock = std::chrono::steady_clock;

double seconds(Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

std::string quantiles(std::vector<double> values) {
  if (values.empty()) return "none";
  std::sort(values.begin(), values.end());
  const auto at = [&](double p) {
    return 1000 * values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1))];
  };
  return fmt::format("median {:.0f} ms, 99 % {:.0f} ms, longest {:.0f} ms", at(0.5), at(0.99),
                     at(1));
}

SourceSettings load_source() {
  SourceSettings source;
  source.name = "load";
  source.mapping.unit = "machine";
  source.mapping.sequence = "n";
  source.mapping.columns = {{"depth", true, "h", read_unit("um", "m"), {}},
                            {"force", false, "", {}, 20.0},
                            {"distance", false, "km", read_unit("km", "m"), {}}};
  return source;
}

// Of the process, now and at most.
std::string memory() {
  std::ifstream status("/proc/self/status");
  std::string now, most;
  for (std::string line; std::getline(status, line);) {
    const auto value = [&] { return std::stod(line.substr(line.find(':') + 1)) / 1e6; };
    if (line.starts_with("VmRSS:")) now = fmt::format("{:.2f} GB", value());
    if (line.starts_with("VmHWM:")) most = fmt::format("{:.2f} GB", value());
  }
  return now + ", at most " + most;
}

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

std::uint64_t readings_known(const Fleet& fleet) {
  std::uint64_t known = 0;
  for (const UnitView& each : fleet.units("", 0, SIZE_MAX)) known += each.quality.readings;
  return known;
}

void report_start(Fleet& fleet, double opened) {
  const Clock::time_point begin = Clock::now();
  while (fleet.apply() > 0) {
  }
  const double applied = opened + seconds(Clock::now() - begin);
  fleet.refresh(true);
  fmt::print("restart: {:.1f} s to the states, {:.1f} s to all forecasts; {} readings; memory {}\n",
             applied, opened + seconds(Clock::now() - begin), readings_known(fleet), memory());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto number = [&](int at, int usual) { return argc > at ? std::atoi(argv[at]) : usual; };
  const int units = number(2, 1000), rate = number(3, 10), length = number(4, 60);
  const std::string url = argc > 5 ? argv[5] : "load.sqlite";
  const auto state = prognosis::read_state(argv[1]);
  std::unique_ptr<const prognosis::Tracker> tracker;
  for (const Model& each : all_models()) {
    if (each.key == state.model && each.track) tracker = each.track(state);
  }
  const auto store = open_store(url, "", {{"depth", "force", "distance"}, {}, true});
  Tally tally(100'000);
  Notices notices(stderr);
  FleetSettings settings;
  settings.population = "load";
  settings.alarm = {10e3, 0.05, 0.2, 0.8, {}};
  settings.threads = 2;
  const Clock::time_point started = Clock::now();
  Fleet fleet(*tracker, *store, tally, notices, settings);
  if (rate == 0) {
    report_start(fleet, seconds(Clock::now() - started));
    return 0;
  }
  Intake intake(*store, tally, notices, [] {});
  const SourceSettings source = load_source();

  // Each unit reports at its own moment of every 1/rate s; those of ten milliseconds are one delivery.
  const int ticks = 100 * length, per_tick = units * rate / 100;
  const Clock::time_point begin = Clock::now() + std::chrono::milliseconds(100);
  const auto due = [&](int tick) { return begin + tick * std::chrono::milliseconds(10); };
  std::vector<double> to_store(ticks), to_view;
  std::atomic<bool> sent = false;
  std::atomic<int> next = 0;
  const auto send = [&] {
    for (int tick = next++; tick < ticks; tick = next++) {
      std::this_thread::sleep_until(due(tick));
      std::vector<Message> messages;
      for (int i = 0; i < per_tick; ++i) {
        const long long k = static_cast<long long>(tick) * per_tick + i;
        const int unit = static_cast<int>(k % units), n = static_cast<int>(k / units) + 1;
        Rng rng(static_cast<std::uint64_t>(unit), static_cast<std::uint64_t>(n));
        const double km = 0.05 * n,
                     depth = (0.5 + 0.0006 * (unit % 1000)) * km + 1.2 * rng.normal();
        messages.push_back(
            {"", fmt::format(R"({{"machine": "M{:04}", "n": {}, "km": {}, "h": {:.4f}}})", unit, n,
                             km, depth)});
      }
      if (!intake.deliver(source, messages).stored) std::abort();
      to_store[tick] = seconds(Clock::now() - due(tick));
    }
  };
  std::vector<std::jthread> senders;
  for (int i = 0; i < 4; ++i) senders.emplace_back(send);
  std::jthread watcher([&] {
    std::vector<std::uint64_t> seen(units, 0);
    Clock::duration look{};
    while (!sent) {
      // All units of a large fleet take long: a look costs at most a twentieth of a processor.
      std::this_thread::sleep_for(
          std::max<Clock::duration>(std::chrono::milliseconds(100), 20 * look));
      const auto now = Clock::now();
      for (const UnitView& each : fleet.units("", 0, SIZE_MAX)) {
        const int unit = std::atoi(each.unit.c_str() + 1);
        for (auto& n = seen[unit]; n < each.quality.readings; ++n)
          to_view.push_back(seconds(now - due(static_cast<int>((n * units + unit) / per_tick))));
      }
      look = Clock::now() - now;
    }
  });
  const double before = processor_seconds();
  std::thread([&] {
    for (std::jthread& each : senders) each.join();
    sent = true;
  }).detach();
  while (!sent) {
    if (fleet.apply() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    fleet.refresh();
  }
  const Clock::time_point over = Clock::now();
  while (fleet.apply() > 0) {
  }
  fleet.refresh(true);
  const double behind = seconds(Clock::now() - over);
  watcher.join();
  const double used = processor_seconds() - before;
  fleet.save();
  std::size_t bytes = 0, states = 0;
  for (const Checkpoint& each : store->states("load")) {
    bytes += each.bytes.size();
    ++states;
  }
  fmt::print("{} units x {} a second for {} s: {} messages sent, {} stored, {} in states\n", units,
             rate, length, static_cast<long long>(ticks) * per_tick, store->count(),
             readings_known(fleet));
  fmt::print("until stored:  {}\n", quantiles(to_store));
  fmt::print("until seen:    {}\n", quantiles(to_view));
  double stored = 0;
  for (int tick = 0; tick < ticks; ++tick) stored = std::max(stored, 0.01 * tick + to_store[tick]);
  const double all = static_cast<double>(ticks) * per_tick, known = seconds(over - begin) + behind;
  fmt::print(
      "all stored after {:.1f} s, {:.0f} a second; in states after {:.1f} s, {:.0f} a second\n",
      stored, all / stored, known, all / known);
  fmt::print("{:.1f} s of processors; {} bytes a unit in the store; memory {}\n", used,
             states ? bytes / states : 0, memory());
}
