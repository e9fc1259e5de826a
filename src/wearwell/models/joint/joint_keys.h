#pragma once

#include "wearwell/input/study_keys.h"

namespace wearwell::joint {

/// All keys that a study of this model may hold.
StudyKeys study_keys();

}  // namespace wearwell::joint
