#pragma once

#include <optional>
#include <vector>

namespace wearwell::joint {

/// Friction work against cycles: zero at 0 cycles, linear between inspections, and at a constant
/// rate after the last.
class WorkHistory {
 public:
  /// Cycles and work [J] of the inspections, in any order, and the work per cycle [J] afterwards;
  /// without a rate no work is done after the last inspection.
  WorkHistory(const std::vector<double>& cycles, const std::vector<double>& work,
              std::optional<double> rate);

  double work_at(double cycles) const;

  /// First number of cycles with this work; infinite if never.
  double cycles_at(double work) const;

 private:
  struct Point {
    double cycles, work;
  };
  std::vector<Point> points_;  // by cycles, from the origin
  double rate_;
};

}  // namespace wearwell::joint
