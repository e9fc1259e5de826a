#pragma once

#include <vector>

#include "wearwell/present/html.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The plots of each section of a report; a plot that a result has no data for is left out.
std::vector<html::Figure> prediction_figures(const PosteriorSummary& result, const Plots& plots);
std::vector<html::Figure> parameter_figures(const PosteriorSummary& result, const Plots& plots);
std::vector<html::Figure> fit_figures(const Plots& plots);
std::vector<html::Figure> sampler_figures(const PosteriorSummary& result, const Plots& plots);

}  // namespace wearwell
