#pragma once

#include "wearwell/models/formula_model/formula_asked.h"

namespace wearwell::formula_model {

/// Whether its first slot is the path of which readings scatter.
bool has_path(const Measured& measured);

/// Reads predict.at: measurements to come of a new unit, and the paths ahead of all that were seen.
/// Throws InputError.
void read_path(const Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
