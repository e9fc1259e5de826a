#pragma once

#include <vector>

#include "wearwell/base/rng.h"
#include "wearwell/models/fatigue/staircase.h"

namespace wearwell::fatigue {

/// Tests and failures by level of stress: one row a test where tests follow each other up and down, else one row a level.
struct StairOutcomes {
  std::vector<std::size_t> level;  ///< of each row
  std::vector<double> tests, failures;
};

/// How the stresses of tests were chosen, so that tests like them can be simulated.
struct StairDesign {
  std::vector<double> log10_stress;  ///< of each level, ascending
  /// A failure is followed by a lower stress, a survivor by a higher one. Then the order of the rows is that of the
  /// tests, and there are levels beyond those tested.
  bool up_and_down = false;
  StairOutcomes observed;

  /// Outcomes of tests by the same rule, of items with this median limit and scale (both of log10).
  StairOutcomes simulate(StandardDistribution limit, double location, double scale, Rng& rng) const;
};

/// Tests are up and down where each row is one test and four fifths of the steps or more go the right way; steps that
/// do not, as between two series, are repeated as they are.
StairDesign stair_design(const std::vector<StairTest>& tests);

/// The sums of the outcomes by level.
StairOutcomes by_level(const StairOutcomes& outcomes, std::size_t levels);

}  // namespace wearwell::fatigue
