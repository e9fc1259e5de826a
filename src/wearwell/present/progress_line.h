#pragma once

#include <chrono>
#include <cstdio>

#include "wearwell/base/monitor.h"

namespace wearwell {

/// A progress line on a terminal: the part of the work, or its progress, speed and remaining time,
/// rewritten in place and erased at the end. Not shown for work that ends within `patience` seconds.
class ProgressLine {
 public:
  /// `terminal`: the output; nullptr for none.
  explicit ProgressLine(std::FILE* terminal, double patience = 0.5)
      : terminal_(terminal), patience_(patience) {}
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const Step& step);

 private:
  std::FILE* terminal_;
  double patience_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool shown_ = false;
};

}  // namespace wearwell
