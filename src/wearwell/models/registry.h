#pragma once

#include "wearwell/study/model.h"

namespace wearwell {

/// All models that wearwell knows.
Models all_models();

}  // namespace wearwell
