#pragma once

#include "wearwell/models/formula_model/formula_asked.h"

namespace wearwell::formula_model {

/// Whether its first parameter is the path around which readings scatter.
bool has_path(const Measured& measured);

/// Reads predict.at: future measurements of a new unit, and the forecasts of all units of the
/// study. Throws InputError.
void read_path(const Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
