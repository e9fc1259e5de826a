#pragma once

#include "wearwell/input/study_keys.h"

namespace wearwell::formula_model {

/// What a study of a law in the user's own words may hold. Most names are the user's; the slots are those of
/// the families.
StudyKeys formula_keys();

}  // namespace wearwell::formula_model
