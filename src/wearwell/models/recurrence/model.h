#pragma once

#include "wearwell/study/model.h"

namespace wearwell::recurrence {

/// Repairable units: model = "repairable" (docs/reference/repairable.md).
Model model();

}  // namespace wearwell::recurrence
