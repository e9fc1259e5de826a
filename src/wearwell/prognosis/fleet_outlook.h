#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wearwell/prognosis/failure_totals.h"
#include "wearwell/prognosis/population_weights.h"
#include "wearwell/prognosis/replacement.h"

namespace wearwell::prognosis {

/// Units in service by column, as many as a fleet has: ages (SI), the distribution that each lives
/// by, and whether the study has it as a run-out of its age, so that its survival is no new evidence.
struct UnitsInService {
  std::vector<double> age;
  std::vector<std::uint32_t> group;
  std::vector<char> in_study;

  std::size_t count() const { return age.size(); }
};

/// What is expected of units in service. Each unit's numbers are averaged over the populations,
/// given that this unit has survived to its age; the numbers of failures over the populations, given
/// that all have.
struct FleetOutlook {
  std::vector<std::vector<double>> failing;  ///< by horizon, by unit: the probability of failure
  std::vector<double> b10, median;           ///< remaining life of each unit, SI; may be infinite
  std::vector<FleetFailures> failures;       ///< by horizon
  PopulationWeights population;              ///< given that all units have survived
  bool interpolated = false;                 ///< between ages (see below)
};

/// Units of one group have equal lives given the population; all groups have the same populations
/// with the same weights. `horizons` count from now on, SI. Numbers are computed once for each age;
/// of a group with more than 1,000 ages at some 1,000 of them, between which they are linear. If the
/// survival of all is more evidence than the populations resolve (`population.resolved`), the
/// numbers of failures rest on the weights without it.
FleetOutlook fleet_outlook(std::span<const PopulationLives> groups, const UnitsInService& units,
                           std::span<const double> horizons);

/// Whether any unit of these lives survives to this age, SI.
bool some_survive(const PopulationLives& lives, double age);

}  // namespace wearwell::prognosis
