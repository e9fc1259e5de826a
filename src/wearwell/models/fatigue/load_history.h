#pragma once

#include <optional>
#include <span>
#include <vector>

#include "wearwell/models/fatigue/cycle_classes.h"
#include "wearwell/models/fatigue/level_crossings.h"
#include "wearwell/models/fatigue/rainflow.h"

namespace wearwell::fatigue {

/// The method of counting a history.
struct CountingRule {
  Counting counting = Counting::four_point;
  Residual residual = Residual::half;
  double class_width = 0;  ///< in the unit of the signal; 0: powers of two

  bool operator==(const CountingRule&) const = default;
};

/// A load history that arrives piece by piece, counted as it arrives. The division into pieces does
/// not change a bit.
class LoadHistory {
 public:
  struct State {
    CountingRule rule;
    long long samples = 0, reversals = 0;
    double lowest = 0, highest = 0;
    TurningPoints::State turn;
    std::optional<double> point;  ///< the last complete one
    std::vector<double> open;
    CycleClasses classes;
    LevelCrossings levels;
  };

  explicit LoadHistory(const CountingRule& rule);
  explicit LoadHistory(State state);
  State state() const;  ///< state to continue from

  /// Finite samples.
  void add(std::span<const double> samples);

  /// The counted cycles, including the residual by its rule.
  struct Counted {
    CycleClasses classes;
    LevelCrossings levels;
    long long samples = 0, reversals = 0;
    double lowest = 0, highest = 0;
    double closed = 0;             ///< cycles that were closed before the end
    std::vector<double> residual;  ///< points that were left then
  };
  Counted counted() const;

 private:
  CountingRule rule_;
  TurningPoints turns_;
  Rainflow rainflow_;
  CycleClasses classes_;
  LevelCrossings levels_;
  std::optional<double> point_;
  long long samples_ = 0, reversals_ = 0;
  double lowest_ = 0, highest_ = 0;
};

}  // namespace wearwell::fatigue
