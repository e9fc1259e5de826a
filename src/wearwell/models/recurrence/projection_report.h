#pragma once

#include "wearwell/models/recurrence/projection.h"
#include "wearwell/models/recurrence/recurrence_report.h"

namespace wearwell::recurrence {

/// The projection of delayed fixes: tables and a figure of first occurrences, terminal text, and `repairable.projection` of
/// summary.json. Crow's estimates stand beside the posterior if the study asks for classical ones. `added.body` has
/// `repairable`.
void add_projection(const Asked& asked, const GrowthTest& test, PresetAddition& added);

/// Adds the mean times between failures after the fixes and of the growth potential to the results of the study.
void ask_projection(const Asked& asked, const GrowthTest& test, const std::string& unit,
                    PosteriorStudy& study);

}  // namespace wearwell::recurrence
