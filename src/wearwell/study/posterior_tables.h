#pragma once

#include <string>
#include <vector>

#include "wearwell/present/table.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The tables of a posterior's report and of its folder `tables/`. Every figure is the best there
/// is: by quadrature where that was done, else from the draws.

/// How lives in this unit are shown: no fraction of a cycle, but of a hundred thousand of them.
present::Format life_format(const std::string& unit, int digits = 4);

present::Table prediction_table(const PosteriorSummary& result);
present::Table stage_prediction_table(const PosteriorSummary& result);  ///< no rows without stages
present::Table life_table(const LifeSummary& life);
present::Table quantity_table(const std::vector<QuantitySummary>& quantities);
/// Properties of all items, for the next one and with a lower bound: two columns that are not to be
/// mistaken for each other.
present::Table bound_table(const std::vector<QuantitySummary>& quantities);
present::Table parameter_table(const std::vector<ParameterSummary>& parameters);
present::Table prior_table(const std::vector<ParameterSummary>& parameters);
present::Table mode_table(const ModeSummary& mode);  ///< of a posterior that has one
present::Table stage_table(const PosteriorSummary& result);
present::Table fit_table(const Plots& plots);
present::Table draws_table(const std::vector<ParameterSummary>& parameters);

}  // namespace wearwell
