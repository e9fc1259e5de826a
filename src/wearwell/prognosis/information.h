#pragma once

#include <span>
#include <vector>

#include "wearwell/prognosis/replacement.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// Possible outcomes of an inspection, and the forecast after each.
struct Outcome {
  double probability = 0;   ///< sum to 1 over all outcomes
  double reading = 0;       ///< SI
  double passed = 0;        ///< the probability that it has failed by then
  WeightedLives remaining;  ///< from then on, given that it has not failed
};

/// The value of another inspection before it is made (preposterior analysis: Raiffa and Schlaifer,
/// Applied Statistical Decision Theory, 1961): with it the time of replacement is chosen after each
/// outcome, without it now. Costs are those of `cheapest_moment`.
struct InspectionWorth {
  double without = 0;   ///< expected cost of the best time, given present knowledge
  double with = 0;      ///< expected cost with the inspection, without the inspection's own cost
  double worth = 0;     ///< without - with: the most that the inspection may cost
  double net = 0;       ///< value less its expected cost
  double replaced = 0;  ///< the probability that the outcome leads to replacement
  /// Deviation of the mixed outcomes from the present forecast: difference of the probability to
  /// have failed by the median of the remaining useful life. It is nonzero if there are too few
  /// outcomes or nodes were rebuilt.
  double error = 0;
};

/// `after`: use until the inspection; the unit fails before with the probability of its remaining
/// useful life, and is not inspected then. Outcomes of units whose failure is evident count only as
/// `passed`.
InspectionWorth inspection_worth(const WeightedLives& remaining, double passed,
                                 std::span<const Outcome> outcomes, double after,
                                 const Costs& costs, double rate);

/// Outcomes of one reading of a unit, by strata of equal probability: the reading at the middle of
/// each stratum of its predictive distribution, found through the unit's predictive p-value
/// (`Taken::surprise`). `reading` has all that is known beforehand, including the axis; `column` is
/// the quantity to be measured. Throws InputError if the unit does not accept such a reading.
std::vector<Outcome> possible_outcomes(const Tracker& tracker, const TrackedUnit& unit,
                                       const Reading& reading, std::size_t column,
                                       const History& history, std::size_t strata = 40);

}  // namespace wearwell::prognosis
