#pragma once

#include <vector>

#include "wearwell/report/html.h"
#include "wearwell/report/result.h"

namespace wearwell {

/// The plots of each section of a report; a plot that a result has no data for is left out.
std::vector<html::Figure> prediction_figures(const StudyResult& result, const Plots& plots);
std::vector<html::Figure> parameter_figures(const StudyResult& result, const Plots& plots);
std::vector<html::Figure> fit_figures(const Plots& plots);
std::vector<html::Figure> sampler_figures(const StudyResult& result, const Plots& plots);

}  // namespace wearwell
