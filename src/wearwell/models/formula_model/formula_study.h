#pragma once

#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Reads the part of a study file that belongs to model "formula": columns, constants, law, likelihoods,
/// priors, what varies from unit to unit, what to predict (docs/reference/formula-models.md). Throws InputError.
void read_formula_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
