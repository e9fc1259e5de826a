#pragma once

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/recurrence/recurrence_report.h"

namespace wearwell::recurrence {

/// Reads [predict] of a study of repairable units: ages, times ahead, confidence and classical estimates. Throws
/// InputError.
void read_predictions(const TomlReader& root, Asked& asked, PosteriorStudy& study);

}  // namespace wearwell::recurrence
