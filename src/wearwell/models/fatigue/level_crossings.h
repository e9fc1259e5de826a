#pragma once

#include <vector>

namespace wearwell::fatigue {

/// Number of upward and downward crossings of each level (ASTM E1049-85, 5.1). Levels are multiples
/// of a width, which doubles if there are too many. A level counts as crossed if the signal comes
/// from below it and reaches it.
class LevelCrossings {
 public:
  static constexpr std::size_t most_levels = 1 << 12;

  /// Increments for later excursions: for level first + i, the number of upward and downward
  /// excursions that cross it as their lowest, minus those that no longer do.
  struct State {
    double wanted = 0, width = 0;
    long long first = 0;
    std::vector<long long> up = {}, down = {};
  };

  /// `width`: levels are multiples of it or of its fractions by powers of two; 0 for a power of
  /// two.
  explicit LevelCrossings(double width = 0) { state_.wanted = width; }
  explicit LevelCrossings(State state) : state_(std::move(state)) {}
  const State& state() const { return state_; }

  /// From one peak or valley to the next.
  void add(double from, double to);

  struct Level {
    double value = 0;
    long long up = 0, down = 0;
  };
  /// At all crossed multiples of `width` (one of the widths of this, or a wider one).
  std::vector<Level> levels(double width) const;

 private:
  long long above(double value) const;  // the first level above
  void make_room(long long level);
  void widen();

  State state_;
};

}  // namespace wearwell::fatigue
