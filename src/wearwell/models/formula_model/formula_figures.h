#pragma once

#include "wearwell/models/formula_model/formula_asked.h"

namespace wearwell::formula_model {

/// Adds figures of the paths that [predict] requests to the study: of a new unit and of each unit,
/// with bands, readings and the threshold.
void add_path_figures(const Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
