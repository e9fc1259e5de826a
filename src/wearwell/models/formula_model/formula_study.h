#pragma once

#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Reads the part of a study file that belongs to model "formula": columns, constants, formula,
/// likelihoods, priors, random effects, predictions (docs/reference/formula-models.md). Throws
/// InputError.
void read_formula_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
