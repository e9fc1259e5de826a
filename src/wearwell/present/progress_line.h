#pragma once

#include <cstdio>

#include "wearwell/base/monitor.h"

namespace wearwell {

/// A progress line on a terminal with progress, speed and remaining time, rewritten in place and
/// erased at the end. Not shown for work that ends within `patience` seconds.
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
  bool shown_ = false;
};

}  // namespace wearwell
