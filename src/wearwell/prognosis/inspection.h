#pragma once

#include "wearwell/prognosis/replacement.h"

namespace wearwell::prognosis {

/// Expectations over one life of a unit under inspection, from new to new.
struct InspectedLife {
  double cost = 0;         ///< total cost
  double length = 0;       ///< length on the axis
  double inspections = 0;  ///< number of inspections
  double failing = 0;      ///< the probability that it fails in service
};

/// Inspected every `interval`; failure shows at the next inspection only, and every unit of the
/// axis until then costs `hidden`: c_i E N + hidden (interval E N - E X) + c_f, with E N = sum of
/// S(k interval) over k = 0, 1, ... (Barlow and Proschan, 1965, chapter 4, section 3). Infinite if
/// some never fail.
InspectedLife hidden_failure(const WeightedLives& lives, const Costs& costs, double hidden,
                             double interval);

/// Inspected every `interval` without error: units that would fail before the next inspection are
/// replaced, so that only failures before the first inspection occur in service. A lower bound on
/// the cost of inspections with this interval.
InspectedLife perfect_inspection(const WeightedLives& lives, const Costs& costs, double interval);

/// The interval with the least long-run cost per unit of the axis, averaged over populations.
struct InspectionInterval {
  double interval = 0;  ///< infinite: no inspection pays
  double rate = 0;
  double from = 0, to = 0;  ///< intervals about it whose rate is at most 1 % above
  double inspections = 0;   ///< per life
  double failing = 0;
};
InspectionInterval cheapest_interval(const PopulationLives& lives, const Costs& costs);
InspectionInterval cheapest_hidden_interval(const PopulationLives& lives, const Costs& costs,
                                            double hidden);

}  // namespace wearwell::prognosis
