#pragma once

#include <span>
#include <vector>

#include "wearwell/prognosis/replacement.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// What an inspection may show, and what is known of the unit then.
struct Outcome {
  double probability = 0;   ///< of all outcomes they sum to 1
  double reading = 0;       ///< SI
  double passed = 0;        ///< the probability that it has failed by then
  WeightedLives remaining;  ///< from then on, given that it has not
};

/// What another inspection is worth before it is made (preposterior analysis: Raiffa and Schlaifer, Applied Statistical
/// Decision Theory, 1961): with it the moment of replacement is chosen after each outcome, without it now. Costs are those of
/// `cheapest_moment`.
struct InspectionWorth {
  double without = 0;   ///< expected cost of the best moment as things are known now
  double with = 0;      ///< expected cost with the inspection, but for the inspection's own
  double worth = 0;     ///< without - with: what the inspection may cost at most
  double net = 0;       ///< worth less what it is expected to cost
  double replaced = 0;  ///< the probability that the unit is replaced upon what it shows
  /// How far the outcomes, mixed, are from what is known now: the difference of the probability to have failed by
  /// the median of the remaining useful life. What is not 0 comes of outcomes that are too few, or nodes laid anew.
  double error = 0;
};

/// `after`: how far ahead the inspection is; the unit fails before with the probability that its remaining useful life says,
/// and is not inspected then. Outcomes are of units whose failure shows by itself only as `passed`.
InspectionWorth inspection_worth(const WeightedLives& remaining, double passed,
                                 std::span<const Outcome> outcomes, double after,
                                 const Costs& costs, double rate);

/// Outcomes of one reading of a unit, by strata of the same probability: the reading whose place in its predictive
/// distribution is the middle of each, found by asking the unit what it would be surprised by (`Taken::surprise`).
/// `reading` has all that is known beforehand, the axis among it; `column` is what is to be measured. Throws InputError where the unit
/// does not take such a reading.
std::vector<Outcome> possible_outcomes(const Tracker& tracker, const TrackedUnit& unit,
                                       const Reading& reading, std::size_t column,
                                       const History& history, std::size_t strata = 40);

}  // namespace wearwell::prognosis
