#pragma once

#include <cstdio>

#include "wearwell/base/monitor.h"

namespace wearwell {

/// A line on a terminal that says how far long work is, how fast it goes and how long it will take,
/// rewritten in place and wiped at the end. Nothing is shown of work that is done within `patience`
/// seconds.
class ProgressLine {
 public:
  /// `terminal`: where to write; nullptr for nowhere.
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
