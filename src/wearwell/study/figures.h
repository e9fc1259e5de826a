#pragma once

#include <vector>

#include "wearwell/present/html.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The figures that answer the study's question: future wear and life, and the remaining useful
/// lives of its units.
std::vector<html::Figure> answer_figures(const PosteriorSummary& result, const Plots& plots);
/// The remaining useful life of each unit, most urgent first; none if fewer than three units have
/// one.
std::vector<html::Figure> remaining_life_figures(const PosteriorSummary& result);

/// The plots of each section of a report; plots without data are omitted.
std::vector<html::Figure> prediction_figures(const PosteriorSummary& result, const Plots& plots);
std::vector<html::Figure> parameter_figures(const PosteriorSummary& result, const Plots& plots);
std::vector<html::Figure> fit_figures(const Plots& plots);
std::vector<html::Figure> sampler_figures(const PosteriorSummary& result, const Plots& plots);

}  // namespace wearwell
