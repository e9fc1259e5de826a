#pragma once

#include <vector>

#include "wearwell/present/plot.h"
#include "wearwell/present/table.h"
#include "wearwell/study/comparison.h"

namespace wearwell {

/// The colour of a study, the same in all plots of a page; beyond six, dashed.
plot::Look look_of_study(std::size_t study, const std::string& name);

/// Lives of each study by what they are of: B10 and, where there are, lower bounds. No rows where no
/// study tells any.
present::Table life_table(const Comparison& comparison);

/// Curves that more than one study drew over the same axes, over each other.
std::vector<html::Figure> curve_figures(const Comparison& comparison);

}  // namespace wearwell
