#pragma once

#include <span>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/plan/inspection_costs.h"

namespace wearwell::plan {

/// Visits to several units, each at a fixed cost beside that of every inspection made.
struct JointVisits {
  std::vector<double> visits;                ///< ascending
  std::vector<std::vector<double>> of_unit;  ///< of these, the times at which each is inspected
  std::vector<InspectionCost> costs;         ///< of each unit, without visits
  double total = 0;                          ///< of all units and visits; infinite if no plan keeps
                                             ///< the bounds
  /// No plan on these candidates costs less: each unit planned alone, charged its equal share of
  /// every visit that it takes part in.
  double least_possible = 0;
};

/// The visits of least expected cost among the candidate times (ascending). Given the visits each
/// unit's inspections are optimal, by dynamic programming over its own life; the set of visits is
/// found by a local search (add, leave out, move one) from several starts, since joint optima over
/// many units are out of reach of exact methods. `least_possible` bounds what that may cost.
/// Throws Cancelled.
JointVisits cheapest_visits(std::span<const LifeAhead> units,
                            std::span<const InspectionBounds> bounds,
                            const InspectionPrices& prices, std::span<const double> candidates,
                            const Monitor& monitor = {});

/// Candidates for visits to all units: the times of each unit planned alone, those of the fewest
/// visits, and evenly spaced ones; multiples of the step if there is one. At most about `most`.
std::vector<double> visit_candidates(std::span<const LifeAhead> units,
                                     std::span<const InspectionBounds> bounds,
                                     const InspectionPrices& prices, std::size_t most = 160);

}  // namespace wearwell::plan
