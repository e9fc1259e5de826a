#pragma once

#include <optional>
#include <vector>

namespace wearwell::joint {

/// Friction work against cycles: none at 0 cycles, evenly from inspection to inspection, and at a
/// constant rate after the last.
class WorkHistory {
 public:
  /// Cycles and work [J] of the inspections, in any order, and the work per cycle [J] of what
  /// comes; without a rate no work is done after the last inspection.
  WorkHistory(const std::vector<double>& cycles, const std::vector<double>& work,
              std::optional<double> rate);

  double work_at(double cycles) const;

  /// When the work is first reached; infinite for never.
  double cycles_at(double work) const;

 private:
  struct Point {
    double cycles, work;
  };
  std::vector<Point> points_;  // by cycles, from the origin
  double rate_;
};

}  // namespace wearwell::joint
