#include "wearwell/models/fatigue/rainflow.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/models/fatigue/load_history.h"

namespace wearwell::fatigue {
namespace {

using Points = std::vector<double>;

struct Counted {
  double range, mean, count;
};

// Every cycle, with no classes between.
std::vector<Counted> rainflow(const Points& signal, Counting counting, Residual residual) {
  std::vector<Counted> cycles;
  Rainflow counter(counting, residual);
  TurningPoints turns;
  const auto take = [&](double from, double to, double count) {
    cycles.push_back({std::abs(to - from), 0.5 * (from + to), count});
  };
  turns.add(signal, [&](double point) { counter.add(point, take); });
  turns.finish([&](double point) { counter.add(point, take); });
  counter.finish(take);
  return cycles;
}

using Table = std::map<std::pair<double, double>, double>;
Table table(const std::vector<Counted>& cycles, double sign = 1, double scale = 1) {
  Table counts;
  for (const Counted& each : cycles)
    counts[{scale * each.range, sign * scale * each.mean + 0.0}] += each.count;
  return counts;
}

std::map<double, double> by_range(const std::vector<Counted>& cycles) {
  std::map<double, double> counts;
  for (const Counted& each : cycles) counts[each.range] += each.count;
  return counts;
}

// ASTM E1049-85 (2017), Fig. 6: points A to I and the table of its cycles.
const Points astm = {-2, 1, -3, 5, -1, 3, -4, 4, -2};

TEST(Rainflow, ExampleOfAstmE1049) {
  const std::map<double, double> published = {{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1}, {9, 0.5}};
  for (const Counting counting : {Counting::three_point, Counting::four_point})
    EXPECT_EQ(by_range(rainflow(astm, counting, Residual::half)), published);
}

// The same, Fig. 7: from D over I = A to D again, as a history that repeats.
TEST(Rainflow, RepeatedExampleOfAstmE1049) {
  const std::map<double, double> published = {{3, 1}, {4, 1}, {7, 1}, {9, 1}};
  EXPECT_EQ(by_range(rainflow(astm, Counting::four_point, Residual::repeat)), published);
  EXPECT_EQ(
      by_range(rainflow({5, -1, 3, -4, 4, -2, 1, -3, 5}, Counting::three_point, Residual::half)),
      published);
}

// Small whole numbers: many equal ranges, and no rounding.
rc::Gen<Points> signals() {
  return rc::gen::map(
      rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-20, 21))),
      [](const std::vector<int>& whole) { return Points(whole.begin(), whole.end()); });
}

const std::pair<Counting, Residual> rules[] = {{Counting::three_point, Residual::half},
                                               {Counting::four_point, Residual::half},
                                               {Counting::four_point, Residual::repeat}};

RC_GTEST_PROP(Rainflow, ThreePointsAndFourCountTheSame, ()) {
  const Points signal = *signals();
  RC_ASSERT(table(rainflow(signal, Counting::three_point, Residual::half)) ==
            table(rainflow(signal, Counting::four_point, Residual::half)));
}

// E1049's simplified counting of a repeating history: begin with the largest point, then by three.
RC_GTEST_PROP(Rainflow, RepeatingIsBeginningWithTheLargest, ()) {
  const Points signal = *signals();
  const auto top = std::max_element(signal.begin(), signal.end());
  Points turned(top, signal.end());
  turned.insert(turned.end(), signal.begin(), top);
  turned.push_back(*top);
  RC_ASSERT(by_range(rainflow(turned, Counting::three_point, Residual::half)) ==
            by_range(rainflow(signal, Counting::four_point, Residual::repeat)));
}

RC_GTEST_PROP(Rainflow, NegatedSignalHasNegatedMeans, ()) {
  Points signal = *signals();
  for (const auto& [counting, residual] : rules) {
    const Table before = table(rainflow(signal, counting, residual), -1);
    Points negated;
    for (const double x : signal) negated.push_back(-x);
    RC_ASSERT(table(rainflow(negated, counting, residual)) == before);
  }
}

RC_GTEST_PROP(Rainflow, BackwardSignalHasTheSameCycles, ()) {
  const Points signal = *signals(), backward(signal.rbegin(), signal.rend());
  for (const auto& [counting, residual] : rules)
    RC_ASSERT(table(rainflow(backward, counting, residual)) ==
              table(rainflow(signal, counting, residual)));
}

RC_GTEST_PROP(Rainflow, ScaledSignalHasScaledCycles, ()) {
  const Points signal = *signals();
  Points scaled;
  for (const double x : signal) scaled.push_back(4 * x);
  for (const auto& [counting, residual] : rules)
    RC_ASSERT(table(rainflow(scaled, counting, residual)) ==
              table(rainflow(signal, counting, residual), 1, 4));
}

RC_GTEST_PROP(Rainflow, HalfCyclesAreAllRanges, ()) {
  const Points signal = *signals();
  int points = 0;
  TurningPoints turns;
  turns.add(signal, [&](double) { ++points; });
  turns.finish([&](double) { ++points; });
  double cycles = 0;
  for (const Counted& each : rainflow(signal, Counting::four_point, Residual::half))
    cycles += each.count;
  RC_ASSERT(cycles == 0.5 * std::max(0, points - 1));
}

double damage(const std::vector<Counted>& cycles, double k) {
  double sum = 0;
  for (const Counted& each : cycles) sum += each.count * std::pow(each.range, k);
  return sum;
}

// Between two samples the signal makes one more cycle.
RC_GTEST_PROP(Rainflow, DamageNeverFallsWhenACycleIsAdded, ()) {
  const Points signal = *signals();
  const auto at =
      static_cast<std::size_t>(*rc::gen::inRange<int>(0, static_cast<int>(signal.size())));
  const double first = *rc::gen::inRange(-25, 26), second = *rc::gen::inRange(-25, 26);
  Points more = signal;
  more.insert(more.begin() + static_cast<std::ptrdiff_t>(at) + 1, {first, second, signal[at]});
  for (const auto& [counting, residual] : rules) {
    for (const double k : {1.0, 3.0, 8.0}) {
      const double before = damage(rainflow(signal, counting, residual), k);
      RC_ASSERT(damage(rainflow(more, counting, residual), k) >= before * (1 - 1e-14));
    }
  }
}

bool same(const LoadHistory::Counted& a, const LoadHistory::Counted& b) {
  const auto levels = [](const LoadHistory::Counted& c) { return c.levels.state(); };
  const auto cells = [](const LoadHistory::Counted& c) {
    return table([&] {
      std::vector<Counted> all;
      for (const CycleClass& each : c.classes.classes())
        all.push_back({each.range, each.mean, each.count});
      return all;
    }());
  };
  return cells(a) == cells(b) && a.classes.width() == b.classes.width() && a.samples == b.samples &&
         a.reversals == b.reversals && a.lowest == b.lowest && a.highest == b.highest &&
         levels(a).up == levels(b).up && levels(a).down == levels(b).down &&
         levels(a).first == levels(b).first && a.residual == b.residual;
}

// However a signal is cut, and also where its state is taken up again, nothing changes.
RC_GTEST_PROP(LoadHistory, StreamedEqualsWhole, ()) {
  const auto signal = *rc::gen::nonEmpty(rc::gen::container<Points>(
      rc::gen::map(rc::gen::arbitrary<int>(), [](int i) { return 1e-6 * i; })));
  for (const auto& [counting, residual] : rules) {
    const CountingRule rule{counting, residual, *rc::gen::element(0.0, 10.0)};
    LoadHistory whole(rule), piecewise(rule);
    whole.add(signal);
    for (std::size_t i = 0; i < signal.size();) {
      const auto count = std::min<std::size_t>(signal.size() - i,
                                               static_cast<std::size_t>(*rc::gen::inRange(1, 9)));
      piecewise.add(std::span(signal).subspan(i, count));
      i += count;
      piecewise = LoadHistory(piecewise.state());
    }
    RC_ASSERT(same(whole.counted(), piecewise.counted()));
  }
}

}  // namespace
}  // namespace wearwell::fatigue
