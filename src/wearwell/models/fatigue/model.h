#pragma once

#include "wearwell/study/model.h"

namespace wearwell::fatigue {

/// Fatigue lives, S-N curves: model = "sn".
Model model();

/// The same model, with what `wearwell new spectrum` writes: tests and a load history.
Model spectrum();

}  // namespace wearwell::fatigue
