#pragma once

#include "wearwell/study/model.h"

namespace wearwell::fatigue {

/// Fatigue lives, S-N curves: model = "sn".
Model model();

/// The same, with strain-controlled tests for `wearwell new strain-life`.
Model strain_life();

/// Fatigue limits from up-and-down tests: model = "staircase".
Model staircase();

/// The S-N model, with the template of `wearwell new spectrum`: tests and a load history.
Model spectrum();

}  // namespace wearwell::fatigue
