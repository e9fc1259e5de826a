#pragma once

#include "wearwell/models/formula_model/formula_asked.h"

namespace wearwell::formula_model {

/// Adds figures of the paths that [predict] asks for to the study: of a new unit and of each one seen, with
/// bands, readings and the limit.
void add_path_figures(const Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
