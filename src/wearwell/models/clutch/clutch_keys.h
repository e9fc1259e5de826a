#pragma once

#include "wearwell/input/study_keys.h"

namespace wearwell::clutch {

/// All keys that a study of this model may hold.
StudyKeys study_keys();

}  // namespace wearwell::clutch
