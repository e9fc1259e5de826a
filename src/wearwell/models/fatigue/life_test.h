#pragma once

#include <vector>

#include "wearwell/models/fatigue/mean_stress.h"

namespace wearwell::fatigue {

/// How a test ended: it broke at `life`; it was stopped unbroken there; it had broken already when
/// it was looked at there; or it broke between `life` and `until`.
enum class Outcome { failure, runout, left, interval };

/// Life tests under one stress that ended alike. Cycles.
struct LifeTest {
  Stress stress;
  Outcome outcome = Outcome::failure;
  double life = 0;   ///< > 0
  double until = 0;  ///< > life, of intervals
  int count = 1;     ///< so many tests ended like this
};

using LifeTests = std::vector<LifeTest>;

}  // namespace wearwell::fatigue
