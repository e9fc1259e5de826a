#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/prognosis/common_population.h"
#include "wearwell/prognosis/fleet_risk.h"
#include "wearwell/prognosis/inspection.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/prognosis/warranty.h"

namespace wearwell::prognosis {

/// The request.
struct Question {
  Costs costs;
  std::string currency;  ///< "EUR"; may be empty
  std::optional<double>
      hidden;  ///< cost per unit of the axis (SI) of a failure that no inspection has found yet
  bool inspected = false;  ///< whether a cost of inspection is given
  /// Use of a unit per month, SI; empty: no forecast by month.
  std::optional<double> per_month;
  int months = 12;
  double service = 0.95;              ///< probability that the spare parts suffice
  std::optional<double> claims = {};  ///< share of units that may claim under warranty
};

/// One unit and its recommended action.
struct UnitDecision {
  const KnownUnit* unit = nullptr;
  UnitReplacement best;
  /// Known by its age alone, it is as old as the age of least cost or older.
  bool past_optimum = false;
  double q05 = 0, q50 = 0, q95 = 0;  ///< remaining useful life, SI
};

/// The fleet up to the end of a month: numbers of units, each counted once.
struct FleetMonth {
  int month = 0;
  double until = 0;  ///< use of each by then, SI
  Count reached;     ///< reach their threshold, if none is replaced before
  Count replaced;    ///< need a new part, each replaced at failure or at its optimal time
  std::size_t low = 0, high = 0;             ///< of `reached`, 5 and 95 %
  std::size_t parts = 0, parts_planned = 0;  ///< spare parts from now until then
};

/// How units are counted: the basis of the numbers in `FleetMonth`.
struct FleetCounting {
  std::size_t populations =
      /// number of shared populations that are averaged over; 0: units are independent
      0;
  double effective = 0;  ///< effective number of them
  std::string why_independent = {};
  bool outgrown = false;  ///< CommonPopulation
};

/// All decisions.
struct Decisions {
  std::optional<AgeReplacement> age;
  /// with perfect inspections, or for hidden failures
  std::optional<InspectionInterval> inspection;
  std::optional<Warranty> warranty = {};
  double reference = 0;  ///< long-run cost per unit of the axis, the reference for running units
  std::vector<UnitDecision> units;  ///< most urgent first
  std::vector<FleetMonth> months;
  FleetCounting counting;  ///< of months
};

/// Throws InputError if these lives cannot answer the request.
Decisions decide(const KnownLives& lives, const Question& question);

}  // namespace wearwell::prognosis
