#pragma once

#include <vector>

namespace wearwell::fatigue {

/// How often a signal crosses each level upward and downward (ASTM E1049-85, 5.1). Levels are wholes
/// of a width, which doubles when there are too many. A level counts as crossed when the signal comes
/// from below it and reaches it.
class LevelCrossings {
 public:
  static constexpr std::size_t most_levels = 1 << 12;

  /// What later excursions are added to: of level first + i, how many upward and downward excursions
  /// cross it as their lowest, less those that no longer do.
  struct State {
    double wanted = 0, width = 0;
    long long first = 0;
    std::vector<long long> up = {}, down = {};
  };

  /// `width`: levels are wholes of it or of its parts by powers of two; 0 for a power of two.
  explicit LevelCrossings(double width = 0) { state_.wanted = width; }
  explicit LevelCrossings(State state) : state_(std::move(state)) {}
  const State& state() const { return state_; }

  /// From one peak or valley to the next.
  void add(double from, double to);

  struct Level {
    double value = 0;
    long long up = 0, down = 0;
  };
  /// At all wholes of `width` (one of the widths of this, or a wider) that are crossed.
  std::vector<Level> levels(double width) const;

 private:
  long long above(double value) const;  // the first level above
  void make_room(long long level);
  void widen();

  State state_;
};

}  // namespace wearwell::fatigue
