#pragma once

#include <optional>
#include <span>
#include <vector>

#include "wearwell/plan/life_ahead.h"

/// Inspections ahead that bound the risk. An inspection shows whether a unit has reached its
/// threshold; all times are use from now on, SI.
///
/// The risk of an interval (s, t] between inspections is [F(t) - F(s)] / [1 - F(s)], F the
/// probability to have reached the threshold: given that the inspection at s finds the unit running.
/// That of the first interval starts from no knowledge but the present: F(t).
namespace wearwell::plan {

/// Where inspections may be, and what they must keep.
struct InspectionBounds {
  double risk = 1;   ///< of each interval, at most
  double until = 0;  ///< the end of the plan; no inspection is needed there
  double step = 0;   ///< inspections at multiples of it; 0: at any time
};

/// Times of inspections, ascending; 0 is now.
struct InspectionTimes {
  std::vector<double> times;
  /// Nothing can keep the bound after this time (a step is too long, or too few points make up the
  /// distribution); `times` end there.
  std::optional<double> stuck = {};
};

/// The fewest inspections: each as late as the bound allows. No plan has fewer. Let g(s) be the
/// latest allowed time after an inspection at s; since 1 - F decreases, g increases with s. If
/// another plan's k-th inspection is not later than the k-th here, its next one is at most
/// g(its k-th) <= g(the k-th here), so by induction it is never ahead and reaches the end no
/// sooner. The same holds on a lattice.
InspectionTimes fewest_inspections(const LifeAhead& life, const InspectionBounds& bounds);

/// Visits at which every unit may be inspected: the fewest that keep each unit's bound, then for
/// each unit the fewest of these at which it is inspected itself. The first is exact, by the same
/// proof with g the earliest of all units' latest times. Each unit's plan ends at its own `until`.
struct Visits {
  InspectionTimes visits;
  std::vector<std::vector<double>> of_unit;  ///< times of each unit's inspections
  std::size_t stuck_unit = 0;                ///< of visits.stuck
};
Visits fewest_visits(std::span<const LifeAhead> units, std::span<const InspectionBounds> bounds);

/// The risk of each interval of a plan, and of the rest up to its end: one more than there are
/// times.
std::vector<double> risks_between(const LifeAhead& life, std::span<const double> times,
                                  double until);

/// Failures that no inspection has foreseen: an inspection shows a failure that comes within
/// `warning` after it (the P-F interval: Moubray, Reliability-centred Maintenance, 1997, chapter
/// 7). The probability that the threshold is reached up to the end and no inspection lies within
/// `warning` before: F(t1) + the sum of F(t_k+1) - F(min(t_k + warning, t_k+1)).
double unforeseen(const LifeAhead& life, std::span<const double> times, double until,
                  double warning);

/// The fewest of the candidate times that keep `unforeseen` at or below `total`, and of those the
/// plan with the least; by dynamic programming over the number of inspections and the last one.
/// Also keeps the bound on each interval. `stuck` is the end if all candidates do not suffice.
InspectionTimes fewest_for_total(const LifeAhead& life, const InspectionBounds& bounds,
                                 double total, double warning, std::span<const double> candidates);

/// Candidate times up to the end: multiples of the step, or, at any time, about `count` places
/// between evenly spaced times and even probabilities.
std::vector<double> candidate_times(const LifeAhead& life, const InspectionBounds& bounds,
                                    std::size_t count = 400);

}  // namespace wearwell::plan
