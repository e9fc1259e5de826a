#pragma once

#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// What model = "staircase" reads beyond what all studies of a posterior have (docs/reference/staircase.md).
/// Throws InputError.
void read_staircase_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
