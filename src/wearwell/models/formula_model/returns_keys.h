#pragma once

#include "wearwell/input/study_keys.h"

namespace wearwell::formula_model {

/// The keys of a returns triangle and its forecast (docs/reference/warranty.md).
StudyKeys returns_keys();

}  // namespace wearwell::formula_model
