#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/prognosis/common_population.h"
#include "wearwell/prognosis/fleet_risk.h"
#include "wearwell/prognosis/inspection.h"
#include "wearwell/prognosis/known_lives.h"

namespace wearwell::prognosis {

/// What is asked.
struct Question {
  Costs costs;
  std::string currency;  ///< "EUR"; may be empty
  std::optional<double>
      hidden;  ///< cost per unit of the axis (SI) of a failure that no inspection has seen yet
  bool inspected = false;  ///< whether a cost of inspection was told
  /// What a unit runs in a month, SI; nothing: no forecast by month.
  std::optional<double> per_month;
  int months = 12;
  double service = 0.95;  ///< probability that spare parts are enough
};

/// One unit and what to do with it.
struct UnitDecision {
  const KnownUnit* unit = nullptr;
  UnitReplacement best;
  double q05 = 0, q50 = 0, q95 = 0;  ///< remaining useful life, SI
};

/// The fleet up to the end of a month: numbers of units, each counted once.
struct FleetMonth {
  int month = 0;
  double until = 0;  ///< what each has run by then, SI
  Count reached;     ///< have reached their limit, if none is replaced before
  Count replaced;    ///< need a new part, each replaced at failure or at its cheapest moment
  std::size_t low = 0, high = 0;             ///< of `reached`, 5 and 95 %
  std::size_t parts = 0, parts_planned = 0;  ///< spare parts from now until then
};

/// How units were counted: on what the numbers of `FleetMonth` rest.
struct FleetCounting {
  std::size_t populations =
      0;                 ///< that units share, over which they are counted; 0: as independent
  double effective = 0;  ///< of them carry it
  std::string why_independent = {};
  bool outgrown = false;  ///< CommonPopulation
};

/// All decisions.
struct Decisions {
  std::optional<AgeReplacement> age;
  std::optional<InspectionInterval> inspection;  ///< perfect, or of hidden failures
  double reference = 0;  ///< cost per unit of the axis that running units are held against
  std::vector<UnitDecision> units;  ///< the most urgent first
  std::vector<FleetMonth> months;
  FleetCounting counting;  ///< of months
};

/// Throws InputError where what is asked cannot be told of such lives.
Decisions decide(const KnownLives& lives, const Question& question);

}  // namespace wearwell::prognosis
