#pragma once

#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// Reads the part of a study file that belongs to model "law": columns, constants, law, likelihoods,
/// priors, what varies from unit to unit, what to predict (docs/reference/law-study.md). Throws InputError.
void read_law_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
