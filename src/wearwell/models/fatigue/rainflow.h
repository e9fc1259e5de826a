#pragma once

#include <cmath>
#include <vector>

#include "wearwell/models/fatigue/turning_points.h"

namespace wearwell::fatigue {

/// The method of finding cycles: by three points and the start of the history (ASTM E1049-85,
/// 5.4.4), or by four, where the inner two lie within the range of the outer two. With the residual
/// in half cycles both give the same counts.
enum class Counting { three_point, four_point };

/// The treatment of unclosed ranges: each counts as half a cycle, or the history is repeated, so
/// that they close (ASTM E1049-85, 5.4.5).
enum class Residual { half, repeat };

/// Rainflow counting of peaks and valleys, in one pass. Only points that are not yet part of a
/// cycle are kept: a few hundred, for any history.
class Rainflow {
 public:
  Rainflow(Counting counting, Residual residual, std::vector<double> open = {})
      : drops_start_(counting == Counting::three_point && residual == Residual::half),
        residual_(residual),
        open_(std::move(open)) {}

  /// The points that are not yet part of a cycle.
  const std::vector<double>& open() const { return open_; }

  /// `take(from, to, count)` for every cycle (1) or half cycle (0.5) that the point completes.
  template <class Take>
  void add(double point, Take&& take) {
    open_.push_back(point);
    while (open_.size() >= 3) {
      const double* end = open_.data() + open_.size();
      const double latest = std::abs(end[-1] - end[-2]), before = std::abs(end[-2] - end[-3]);
      if (latest < before) return;
      if (open_.size() > 3) {
        if (before > std::abs(end[-3] - end[-4])) return;
        take(end[-3], end[-2], 1.0);
        open_[open_.size() - 3] = point;
        open_.resize(open_.size() - 2);
      } else if (drops_start_) {
        take(end[-3], end[-2], 0.5);
        open_.erase(open_.begin());
      } else {
        return;
      }
    }
  }

  /// The rest, at the end of the history.
  template <class Take>
  void finish(Take&& take) {
    if (residual_ == Residual::half) {
      for (std::size_t i = 1; i < open_.size(); ++i) take(open_[i - 1], open_[i], 0.5);
      return;
    }
    // Where one repetition ends and the next begins the signal may not turn.
    Rainflow twice(Counting::four_point, Residual::repeat);
    TurningPoints turns;
    const auto add = [&](double point) { twice.add(point, take); };
    turns.add(open_, add);
    turns.add(open_, add);
    turns.finish(add);
  }

 private:
  bool drops_start_;
  Residual residual_;
  std::vector<double> open_;
};

}  // namespace wearwell::fatigue
