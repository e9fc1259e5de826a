#pragma once

#include "wearwell/input/study_keys.h"

namespace wearwell::formula_model {

/// The keys of a formula study. Most names are the user's; parameters are those of the families.
StudyKeys formula_keys();

}  // namespace wearwell::formula_model
