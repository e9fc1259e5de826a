// Fleets of units on line that change after their tenth reading: how soon the forecast is in doubt, whether the reason is the right
// one, how many right units are doubted, and what becomes of 90 % intervals of the remaining useful life. Every fifty units belong to a
// population of their own, learned from 12 machines. WEARWELL_REPLICATIONS says how many units a fleet has, WEARWELL_FLEET which fleet
// is simulated alone (its name in the table).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "calibration/changing_units.h"

namespace wearwell::formula_model {
namespace {

int fleet_size() {
  const char* wanted = std::getenv("WEARWELL_REPLICATIONS");
  return wanted ? std::max(50, std::atoi(wanted)) : 1000;
}

struct Coverage {
  int forecasts = 0, held = 0;
  std::vector<double> width = {};  // of the interval, as a multiple of its median
  void add(bool holds, double relative_width) {
    ++forecasts;
    held += holds;
    width.push_back(relative_width);
  }
  void add(const Coverage& other) {
    forecasts += other.forecasts;
    held += other.held;
    width.insert(width.end(), other.width.begin(), other.width.end());
  }
  double median_width() {
    if (width.empty()) return NAN;
    const auto middle = width.begin() + static_cast<std::ptrdiff_t>(width.size() / 2);
    std::nth_element(width.begin(), middle, width.end());
    return *middle;
  }
  double percent() const { return forecasts > 0 ? 100.0 * held / forecasts : NAN; }
};

struct FleetCounts {
  int units = 0, doubted_before = 0, changed = 0, found = 0, beyond = 0, named = 0;
  std::vector<int> delay;
  /// Remaining useful life: before the change, after it, and of these without doubt.
  Coverage before, after, undoubted;

  void add(const FleetCounts& other) {
    units += other.units;
    doubted_before += other.doubted_before;
    changed += other.changed;
    found += other.found;
    beyond += other.beyond;
    named += other.named;
    delay.insert(delay.end(), other.delay.begin(), other.delay.end());
    for (const auto of : {&FleetCounts::before, &FleetCounts::after, &FleetCounts::undoubted})
      (this->*of).add(other.*of);
  }
};

bool holds(const prognosis::Forecast& forecast, double remaining) {
  if (forecast.remaining.points().empty()) return remaining <= 0;
  const double place =
      forecast.passed + (1 - forecast.passed) * forecast.remaining.cdf(remaining * Guides::h);
  return place >= 0.05 && place <= 0.95;
}

double relative_width(const prognosis::Forecast& forecast) {
  if (forecast.remaining.points().empty()) return 0;
  const auto at = [&](double p) { return forecast.remaining.quantile(p); };
  return (at(0.95) - at(0.05)) / at(0.5);
}

void follow(const Guides& guides, const Change& change, bool may_change,
            const std::vector<Shown>& shown, FleetCounts& counts) {
  const std::size_t changes = change.from_start ? 0 : changes_after;
  WatchedGuide guide(guides, "new", may_change);
  ++counts.units;
  const bool changed = shown.size() > changes && change.named[0] != 0;
  counts.changed += changed;
  bool doubted_before = false, found = false, named = false;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    guide.read(shown[i].use, shown[i].wear);
    const bool doubt = guide.watch.in_doubt(), alarm = doubt || guide.watch.is_beyond();
    const bool after = i >= changes && change.named[0] != 0;
    doubted_before |= doubt && !after;
    if (after && !found && alarm) {
      found = true;
      counts.delay.push_back(static_cast<int>(i - changes) + 1);
    }
    if (after) named |= guide.watch.reason().find(change.named) != std::string::npos;
    // Forecasts after 6, 8, 10, 12, 15, 20 and 25 readings.
    if (i != 5 && i != 7 && i != 9 && i != 11 && i != 14 && i != 19 && i != 24) continue;
    const prognosis::Forecast forecast = guide.unit->forecast();
    const bool right = holds(forecast, shown[i].remaining);
    const double width = relative_width(forecast);
    if (!after) counts.before.add(right, width);
    if (after) counts.after.add(right, width);
    if (after && !alarm) counts.undoubted.add(right, width);
  }
  counts.doubted_before += doubted_before;
  counts.found += found;
  counts.named += named;
}

constexpr int of_population = 50;

std::vector<std::unique_ptr<Guides>> populations(int units) {
  std::vector<std::unique_ptr<Guides>> all(
      static_cast<std::size_t>((units + of_population - 1) / of_population));
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t p) {
    Rng rng(20261125, p);
    all[p] = std::make_unique<Guides>(12, rng);
  });
  return all;
}

FleetCounts fleet_of(const Change& change, bool may_change,
                     const std::vector<std::unique_ptr<Guides>>& guides, std::uint64_t first) {
  std::vector<FleetCounts> parts(guides.size());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t p) {
    Rng rng(20261125, first + p);
    if (!guides[p]->tracker) return;
    for (int u = 0; u < of_population; ++u)
      follow(*guides[p], change, may_change, change.readings(rng), parts[p]);
  });
  FleetCounts all;
  for (const FleetCounts& each : parts) all.add(each);
  return all;
}

std::string covered(Coverage of) {
  return of.forecasts > 0 ? fmt::format("{:.1f} %, {:.2f}", of.percent(), of.median_width()) : "";
}

constexpr const char* head =
    "| fleet | doubted before the change | found | delay in readings: median, 90 % | right reason "
    "| before: coverage, width | after | after, not in doubt (forecasts) |\n"
    "|---|---|---|---|---|---|---|---|\n";

// One line of the table in docs/explanation/validation.md. A changed rate is no reason for doubt where rates may change.
void print(const Change& change, bool may_change, FleetCounts& counts) {
  std::sort(counts.delay.begin(), counts.delay.end());
  const auto delay = [&](double p) {
    return counts.delay[static_cast<std::size_t>(p * static_cast<double>(counts.delay.size() - 1))];
  };
  const bool changes = change.named[0] != 0;
  const double changed = std::max(counts.changed, 1);
  const bool model_has_it = may_change && std::string_view(change.named) == "rate has changed";
  const Coverage& undoubted = counts.undoubted;
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", change.name,
             change.from_start ? "" : fmt::format("{} of {}", counts.doubted_before, counts.units),
             changes ? fmt::format("{:.1f} %", 100 * counts.found / changed) : "",
             counts.delay.empty() ? "" : fmt::format("{}, {}", delay(0.5), delay(0.9)),
             changes && !model_has_it ? fmt::format("{:.0f} %", 100 * counts.named / changed) : "",
             covered(counts.before), covered(counts.after),
             undoubted.forecasts > 0
                 ? fmt::format("{:.1f} % ({})", undoubted.percent(), undoubted.forecasts)
             : changes ? "none"
                       : "");
  std::fflush(stdout);
}

void compare_fleets(bool may_change) {
  const int units = fleet_size();
  fmt::print("{}, {} units a fleet\n{}", may_change ? "rates may change" : "one rate", units, head);
  const auto guides = populations(units);
  const char* const wanted = std::getenv("WEARWELL_FLEET");
  std::uint64_t first = 0;
  int simulated = 0;
  for (const Change& change : changes()) {
    first += 1000;
    if (wanted && change.name != std::string_view(wanted)) continue;
    ++simulated;
    FleetCounts counts = fleet_of(change, may_change, guides, first);
    print(change, may_change, counts);
    EXPECT_GE(counts.units, units);
    // One in 1,000, and three standard errors.
    const double expected = 0.001 * counts.units;
    EXPECT_LE(counts.doubted_before, expected + 3 * std::sqrt(expected) + 1) << change.name;
    if (change.named[0] == 0) {
      // Units whose rate does not change live within intervals that allow for it.
      EXPECT_NEAR(counts.before.percent(), may_change ? 94 : 90, may_change ? 6 : 4);
    }
    if (may_change && std::string(change.name).ends_with(" times")) {
      EXPECT_GT(counts.after.percent(), 60) << change.name;
    }
  }
  EXPECT_GT(simulated, 0) << "no fleet has the name in WEARWELL_FLEET";
}

TEST(ChangeWatch, OfFleetsThatChange) {
  compare_fleets(false);
}

// The same units in a study with predict.rate_change.
TEST(ChangeWatch, OfFleetsWhoseRateMayChange) {
  compare_fleets(true);
}

}  // namespace
}  // namespace wearwell::formula_model
