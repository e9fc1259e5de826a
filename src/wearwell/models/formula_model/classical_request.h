#pragma once

#include "wearwell/models/formula_model/mode_answers.h"

namespace wearwell::formula_model {

/// Adds the classical estimates of a life (predict.classical) to the result. Throws InputError where
/// they do not apply at all.
void add_classical_estimates(const AskedOfModes& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
