#pragma once

#include <span>
#include <vector>

namespace wearwell::fatigue {

/// The peaks and valleys of a signal that arrives piece by piece: its turning points, its first
/// sample, and at the end its last. They do not depend on the division into pieces.
class TurningPoints {
 public:
  /// The state that the next piece depends on.
  struct State {
    bool begun = false;
    int direction = 0;  ///< +1 rising, -1 falling, 0 while all samples are equal
    double last = 0;    ///< the extreme sample in that direction: a point once the signal turns
  };

  TurningPoints() = default;
  explicit TurningPoints(const State& state) : state_(state) {}
  const State& state() const { return state_; }

  /// `take(point)` for every point that these samples complete. Samples are finite.
  template <class Take>
  void add(std::span<const double> samples, Take&& take) {
    std::size_t i = 0;
    const std::size_t n = samples.size();
    if (n == 0) return;
    if (!state_.begun) state_ = {true, 0, samples[i++]};
    double last = state_.last;
    if (state_.direction == 0) {
      while (i < n && samples[i] == last) ++i;
      if (i == n) return;
      state_.direction = samples[i] > last ? 1 : -1;
      take(last);
      last = samples[i++];
    }
    bool rising = state_.direction > 0;
    while (i < n) {
      if (rising) {
        while (i < n && samples[i] >= last) last = samples[i++];
      } else {
        while (i < n && samples[i] <= last) last = samples[i++];
      }
      if (i == n) break;
      take(last);
      last = samples[i++];
      rising = !rising;
    }
    state_.last = last;
    state_.direction = rising ? 1 : -1;
  }

  /// The last sample, which ends the signal as a point; none for a constant one.
  template <class Take>
  void finish(Take&& take) const {
    if (state_.direction != 0) take(state_.last);
  }

 private:
  State state_;
};

}  // namespace wearwell::fatigue
