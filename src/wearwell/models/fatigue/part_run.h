#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/models/fatigue/damage.h"

namespace wearwell::fatigue {

/// Whether two stresses are one: equal to 1e-6 of the larger.
bool is_same_stress(const Stress& a, const Stress& b);

/// What a part has run under. The order of its loads does not matter to Miner's sum, so cycles are
/// kept by stress.
struct PartRun {
  LoadCycles cycles = {};  ///< one per stress, ascending; counts are positive and sum to `now`
  double now = 0;          ///< all cycles since the beginning
  std::optional<Stress> last = {};  ///< of the last cycles, or known before any

  /// The cycles from `now` until there run under this stress.
  void add(double until, const Stress& stress);
  /// Whether it has run under this stress alone, or not at all.
  bool is_under(const Stress& stress) const;
};

/// A reading: all cycles since the beginning, and the stress since the reading before it along the
/// life, which is that reading's stress if it is empty.
struct RunReading {
  double cycles = 0;
  std::optional<Stress> stress = {};
};

/// The run of a part after these readings, in any order: they are sorted along its life, and those of
/// equal cycles with another stress, or before `begun.now`, are left out.
PartRun run_after(PartRun begun, std::vector<RunReading> readings);

/// The stress of the cycles before a reading at exactly these cycles, stated or carried on from the
/// reading before it; none if no reading is there.
std::optional<Stress> stress_until(const PartRun& begun, std::vector<RunReading> readings,
                                   double cycles);

}  // namespace wearwell::fatigue
