#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/plan/inspection_times.h"

/// Expected cost of inspecting one unit from now until the end of a plan, by the distribution of
/// its own life.
namespace wearwell::plan {

/// What inspections and failures cost, in one currency, and what an inspection shows.
struct InspectionPrices {
  double inspection = 0;
  double failure = 0;      ///< a unit that reaches its threshold in service, with its replacement
  double replacement = 0;  ///< a preventive replacement
  /// Failures are hidden: an inspection shows only failed or not, and each unit of use until then
  /// costs so much. Empty: failures are evident, and an inspection shows one that comes within
  /// `warning` after it; the unit is then replaced at the last inspection before.
  std::optional<double> downtime = {};
  double warning = std::numeric_limits<double>::infinity();
  double use = 0;    ///< value of each unit of use that a preventive replacement loses
  double visit = 0;  ///< of each visit, whatever the number of units inspected; certain
};

/// Expectations of a plan.
struct InspectionCost {
  double total = 0;
  double inspections = 0;  ///< number of inspections made: none after a failure is known
  double failing = 0;      ///< the probability of a failure in service
  double replaced = 0;     ///< the probability of a preventive replacement
  double downtime = 0;     ///< use after a hidden failure
  double lost = 0;         ///< use that preventive replacement loses
};

/// The state at a time of inspection.
struct InspectionPlace {
  double time = 0, reached = 0, used = 0;  ///< LifeAhead at that time
  double shown = 0, used_shown = 0;        ///< LifeAhead at the end of the warning
};
/// Before the first inspection: nothing was inspected.
inline constexpr double not_inspected = -1;
InspectionPlace inspection_place(const LifeAhead& life, const InspectionPrices& prices,
                                 double time);

/// What happens from one inspection (or the start, `not_inspected`) to the next one or the end. With
/// hidden failures (Barlow and Proschan, Mathematical Theory of Reliability, 1965, chapter 4,
/// section 3):
///
///     c_f [F(t) - F(s)] + d (the integral of F(x) - F(s) from s to t) + c_i [1 - F(s)]
///
/// the last if there is an inspection at t. With evident ones, m = min(s + warning, t):
///
///     c_i [1 - F(s)] + c_p [F(m) - F(s)] + g (the integral of x - s over dF from s to m)
///         + c_f [F(t) - F(m)]
InspectionCost between(const InspectionPlace& from, const InspectionPlace& to, bool inspected_at_to,
                       const InspectionPrices& prices);

/// The cost of these times.
InspectionCost cost_of(const LifeAhead& life, std::span<const double> times, double until,
                       const InspectionPrices& prices);

/// The sequence of least expected cost that keeps the bound on each interval: dynamic programming
/// over the candidates (`candidate_times`), exact among them; without a step each time is then moved
/// to the least between its neighbours until nothing is gained.
struct CheapestTimes {
  InspectionTimes plan;
  InspectionCost cost;
};
CheapestTimes cheapest_inspections(const LifeAhead& life, const InspectionBounds& bounds,
                                   const InspectionPrices& prices);

/// Times at every `interval` before the end.
std::vector<double> equal_times(double interval, double until);

/// Whether these times keep the bound on each interval.
bool keeps_risk(const LifeAhead& life, std::span<const double> times,
                const InspectionBounds& bounds);

/// The equal interval of least cost that keeps the bound, among those that divide the horizon finely (multiples of the
/// step, if there is one); infinite if no inspection is cheaper, or
/// none keeps the bound.
struct EqualInterval {
  double interval = 0;
  InspectionCost cost;
};
EqualInterval cheapest_equal(const LifeAhead& life, const InspectionBounds& bounds,
                             const InspectionPrices& prices);

}  // namespace wearwell::plan
