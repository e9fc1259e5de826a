#include "wearwell/models/fatigue/load_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "support/scratch.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/models/fatigue/history_report.h"
#include "wearwell/models/fatigue/history_state.h"

namespace wearwell::fatigue {
namespace {

std::vector<double> noise(std::size_t count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(20, 30);
  std::vector<double> signal(count);
  for (double& x : signal) x = normal(random);
  return signal;
}

// Equal cycles keep their values whatever the classes are.
TEST(CycleClasses, EqualCyclesAreExact) {
  CycleClasses classes;
  for (int i = 0; i < 100'000; ++i) classes.add(100.0 / 3, 10.0 / 7, 1);
  ASSERT_EQ(classes.classes().size(), 1u);
  EXPECT_EQ(classes.classes()[0].range, 100.0 / 3);
  EXPECT_EQ(classes.classes()[0].mean, 10.0 / 7);
  EXPECT_EQ(classes.classes()[0].count, 1e5);
}

// Too many classes become wider ones; sums of range and mean stay.
TEST(CycleClasses, AreBoundedAndKeepTheirSums) {
  CycleClasses classes;
  double count = 0, range_sum = 0, mean_sum = 0, damage = 0;
  const std::vector<double> values = noise(600'000);
  for (std::size_t i = 1; i < values.size(); i += 2) {
    const double range = std::abs(values[i]) + 0.1, mean = values[i - 1];
    classes.add(range, mean, 1);
    ++count;
    range_sum += range;
    mean_sum += mean;
    damage += std::pow(range, 8);
  }
  EXPECT_LE(classes.cells().size(), CycleClasses::most_classes);
  double counted = 0, ranges = 0, means = 0, by_classes = 0;
  for (const CycleClass& each : classes.classes()) {
    counted += each.count;
    ranges += each.count * each.range;
    means += each.count * each.mean;
    by_classes += each.count * std::pow(each.range, 8);
  }
  EXPECT_EQ(counted, count);
  EXPECT_NEAR(ranges, range_sum, 1e-9 * range_sum);
  EXPECT_NEAR(means, mean_sum, 1e-9 * std::abs(mean_sum));
  EXPECT_NEAR(by_classes, damage, 1e-4 * damage);
}

// Counted from the samples, one level after the other.
TEST(LevelCrossings, AreThoseOfTheSamples) {
  const std::vector<double> signal = noise(20'000);
  for (const double wanted : {0.0, 7.0}) {
    LoadHistory history(CountingRule{Counting::four_point, Residual::half, wanted});
    history.add(signal);
    const auto levels = history.counted().levels.levels(wanted > 0 ? wanted : 8);
    ASSERT_GT(levels.size(), 10u);
    for (const LevelCrossings::Level& level : levels) {
      long long up = 0, down = 0;
      for (std::size_t i = 1; i < signal.size(); ++i) {
        up += signal[i - 1] < level.value && signal[i] >= level.value;
        down += signal[i - 1] >= level.value && signal[i] < level.value;
      }
      EXPECT_EQ(level.up, up) << level.value;
      EXPECT_EQ(level.down, down) << level.value;
    }
  }
}

using HistoryState = ScratchTest;

// Through the file of a state no bit is lost.
TEST_F(HistoryState, GoesOnAsIfItHadNeverEnded) {
  const std::vector<double> signal = noise(50'000);
  for (const Residual residual : {Residual::half, Residual::repeat}) {
    const CountingRule rule{Counting::three_point, residual, 0};
    LoadHistory whole(rule), first(rule);
    whole.add(signal);
    first.add(std::span(signal).first(20'001));
    const auto file = folder() / "state.json";
    write_file(file, state_text({"load", "MPa", first.state()}));
    SavedHistory saved = read_history_state(file);
    EXPECT_EQ(saved.column, "load");
    EXPECT_EQ(saved.unit, "MPa");
    LoadHistory rest(std::move(saved.state));
    rest.add(std::span(signal).subspan(20'001));
    EXPECT_EQ(state_text({"", "", rest.state()}), state_text({"", "", whole.state()}));
    const HistoryReport a{"f", "c", "MPa", rule, rest.counted()},
        b{"f", "c", "MPa", rule, whole.counted()};
    EXPECT_EQ(history_json(a).dump(), history_json(b).dump());
  }
}

// Classes that are asked for hold what belongs there: counted one by one.
TEST(HistoryReport, ClassesOfAWidth) {
  LoadHistory history(CountingRule{Counting::four_point, Residual::half, 10});
  const std::vector<double> signal = noise(30'000);
  history.add(signal);
  std::map<double, double> expected;
  Rainflow counter(Counting::four_point, Residual::half);
  TurningPoints turns;
  const auto take = [&](double from, double to, double count) {
    expected[10 * std::floor(std::abs(to - from) / 10)] += count;
  };
  turns.add(signal, [&](double point) { counter.add(point, take); });
  turns.finish([&](double point) { counter.add(point, take); });
  counter.finish(take);
  const auto table = spectrum_table({"f", "c", "MPa", {}, history.counted()});
  std::map<double, double> shown;
  for (const auto& row : table.rows) shown[std::get<double>(row[0])] = std::get<double>(row[2]);
  EXPECT_EQ(shown, expected);
}

}  // namespace
}  // namespace wearwell::fatigue
