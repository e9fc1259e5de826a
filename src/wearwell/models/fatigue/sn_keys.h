#pragma once

#include "wearwell/input/study_keys.h"

namespace wearwell::fatigue {

/// All keys that a study of this model may hold.
StudyKeys study_keys();

/// And of model "staircase".
StudyKeys staircase_keys();

}  // namespace wearwell::fatigue
