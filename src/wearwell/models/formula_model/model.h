#pragma once

#include "wearwell/study/model.h"

namespace wearwell::formula_model {

/// Laws in the user's own words, and what `wearwell new formula` writes.
Model model();

/// The same model, with what `wearwell new life`, `new accelerated`, `new degradation` and
/// `new fleet` write.
Model life();
Model accelerated();
Model degradation();
Model fleet();

}  // namespace wearwell::formula_model
