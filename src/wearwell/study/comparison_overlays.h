#pragma once

#include <vector>

#include "wearwell/present/plot.h"
#include "wearwell/present/table.h"
#include "wearwell/study/comparison.h"

namespace wearwell {

/// The color of a study, the same in all plots of a page; studies beyond six are dashed.
plot::Look look_of_study(std::size_t study, const std::string& name);

/// The lives of each study: B10 and, if available, lower bounds. No rows if no study reports any.
present::Table life_table(const Comparison& comparison);

/// Overlaid curves that more than one study drew on the same axes.
std::vector<html::Figure> curve_figures(const Comparison& comparison);

}  // namespace wearwell
