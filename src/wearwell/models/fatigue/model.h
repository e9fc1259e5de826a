#pragma once

#include "wearwell/study/model.h"

namespace wearwell::fatigue {

/// Fatigue lives, S-N curves: model = "sn".
Model model();

}  // namespace wearwell::fatigue
