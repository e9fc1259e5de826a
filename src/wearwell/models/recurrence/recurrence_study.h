#pragma once

#include "wearwell/study/posterior_study.h"

namespace wearwell::recurrence {

/// The keys of model = "repairable" in addition to those of all posterior studies (docs/reference/repairable.md). Throws
/// InputError.
void read_recurrence_study(const TomlReader& root, const Source& source, PosteriorStudy& study);

}  // namespace wearwell::recurrence
