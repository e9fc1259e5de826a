#pragma once

#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// The keys of model = "staircase" in addition to those of all posterior studies
/// (docs/reference/staircase.md). Throws InputError.
void read_staircase_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell
