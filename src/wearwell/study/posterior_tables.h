#pragma once

#include <string>
#include <vector>

#include "wearwell/present/table.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The tables of a posterior's report and of its folder `tables/`. Numbers are from quadrature if
/// available, else from the draws.

/// The format of lives in this unit: whole cycles, but fractions of 10^5 cycles.
present::Format life_format(const std::string& unit, int digits = 4);

present::Table prediction_table(const PosteriorSummary& result);
present::Table stage_prediction_table(const PosteriorSummary& result);  ///< no rows without stages
present::Table life_table(const LifeSummary& life);
present::Table quantity_table(const std::vector<QuantitySummary>& quantities);
/// Properties of the population: the value for the next item and the lower bound, in separate
/// columns.
present::Table bound_table(const std::vector<QuantitySummary>& quantities);
present::Table parameter_table(const std::vector<ParameterSummary>& parameters);
present::Table prior_table(const std::vector<ParameterSummary>& parameters);
present::Table mode_table(const ModeSummary& mode);  ///< of a posterior that has a mode
present::Table stage_table(const PosteriorSummary& result);
present::Table fit_table(const Plots& plots);
present::Table draws_table(const std::vector<ParameterSummary>& parameters);

}  // namespace wearwell
