#include "wearwell/models/fatigue/load_history.h"

#include <algorithm>
#include <cmath>

namespace wearwell::fatigue {
namespace {

auto into(CycleClasses& classes) {
  return [&classes](double from, double to, double count) {
    classes.add(std::abs(to - from), 0.5 * from + 0.5 * to, count);
  };
}

}  // namespace

LoadHistory::LoadHistory(const CountingRule& rule)
    : rule_(rule),
      rainflow_(rule.counting, rule.residual),
      classes_(rule.class_width),
      levels_(rule.class_width) {}

LoadHistory::LoadHistory(State state)
    : rule_(state.rule),
      turns_(state.turn),
      rainflow_(state.rule.counting, state.rule.residual, std::move(state.open)),
      classes_(std::move(state.classes)),
      levels_(std::move(state.levels)),
      point_(state.point),
      samples_(state.samples),
      reversals_(state.reversals),
      lowest_(state.lowest),
      highest_(state.highest) {}

LoadHistory::State LoadHistory::state() const {
  return {rule_,          samples_, reversals_,       lowest_,  highest_,
          turns_.state(), point_,   rainflow_.open(), classes_, levels_};
}

void LoadHistory::add(std::span<const double> samples) {
  if (samples.empty()) return;
  if (samples_ == 0) lowest_ = highest_ = samples.front();
  samples_ += std::ssize(samples);
  turns_.add(samples, [&](double point) {
    ++reversals_;
    lowest_ = std::min(lowest_, point);
    highest_ = std::max(highest_, point);
    if (point_) levels_.add(*point_, point);
    point_ = point;
    rainflow_.add(point, into(classes_));
  });
}

LoadHistory::Counted LoadHistory::counted() const {
  LoadHistory whole(*this);
  turns_.finish([&](double point) {
    ++whole.reversals_;
    whole.lowest_ = std::min(lowest_, point);
    whole.highest_ = std::max(highest_, point);
    if (point_) whole.levels_.add(*point_, point);
    whole.rainflow_.add(point, into(whole.classes_));
  });
  double closed = 0;
  for (const CycleClasses::Cell& cell : whole.classes_.cells()) closed += cell.count;
  std::vector<double> residual = whole.rainflow_.open();
  whole.rainflow_.finish(into(whole.classes_));
  return {std::move(whole.classes_),
          std::move(whole.levels_),
          samples_,
          whole.reversals_,
          whole.lowest_,
          whole.highest_,
          closed,
          std::move(residual)};
}

}  // namespace wearwell::fatigue
