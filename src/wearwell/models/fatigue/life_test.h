#pragma once

#include <vector>

#include "wearwell/models/fatigue/mean_stress.h"

namespace wearwell::fatigue {

/// How a test ended: failure at `life`; stopped there without failure; failed before an inspection
/// there; or failed between `life` and `until`.
enum class Outcome { failure, runout, left, interval };

/// Life tests under one stress with the same outcome. Cycles.
struct LifeTest {
  Stress stress;
  Outcome outcome = Outcome::failure;
  double life = 0;   ///< > 0
  double until = 0;  ///< > life, of intervals
  int count = 1;     ///< number of tests with this outcome
};

using LifeTests = std::vector<LifeTest>;

}  // namespace wearwell::fatigue
