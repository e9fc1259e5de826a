#pragma once

#include "wearwell/input/study_keys.h"

namespace wearwell::recurrence {

StudyKeys study_keys();

}  // namespace wearwell::recurrence
