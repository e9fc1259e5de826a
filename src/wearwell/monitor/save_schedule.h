#pragma once

#include <algorithm>
#include <chrono>

namespace wearwell::monitor {

/// When the states of a fleet are saved next: those of very many units take long, and readings wait
/// meanwhile.
class SaveSchedule {
 public:
  using Clock = std::chrono::steady_clock;
  /// At least `least` lies between two saves, and `times` as long as the last one took.
  SaveSchedule(Clock::duration least, int times, Clock::time_point now)
      : least_(least), times_(times), next_(now + least) {}

  bool is_due(Clock::time_point now) const { return now >= next_; }
  void saved(Clock::time_point begin, Clock::time_point end) {
    next_ = end + std::max(least_, times_ * (end - begin));
  }

 private:
  Clock::duration least_;
  int times_;
  Clock::time_point next_;
};

}  // namespace wearwell::monitor
