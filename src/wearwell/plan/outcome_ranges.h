#pragma once

#include <span>
#include <vector>

#include "wearwell/plan/outcomes.h"

namespace wearwell::plan {

/// The scale on which outcomes are integrated: ln y where values are positive, else y. Unit of the
/// table.
struct OutcomeScale {
  bool logarithmic = false;

  double value(double t) const;
  double place(double y) const;
  double log_slope(double t) const { return logarithmic ? t : 0; }  ///< of ln(dy/dt)
};

/// Where the outcomes of a test lie under all of some nodes, on that scale.
struct OutcomeRange {
  double low = 0, high = 0;
  double narrowest = 1;   ///< standard deviation of the narrowest of the distributions
  double impossible = 0;  ///< weight of nodes under which no value has a density
};

/// By successive grids over a few of the nodes, `scouts`: normal distributions are found exactly
/// from any distance, others by narrowing.
std::vector<OutcomeRange> outcome_ranges(const TestStudy& study, const Table& conditions,
                                         std::span<const PlannedTest> tests, const Points& scouts,
                                         std::span<const double> weights);

}  // namespace wearwell::plan
