#pragma once

#include "wearwell/study/model.h"

namespace wearwell::formula_model {

/// Formula models, and the template of `wearwell new formula`.
Model model();

/// The same model, with the templates of `wearwell new life`, `new accelerated`, `new degradation`
/// and `new fleet`.
Model life();
Model accelerated();
Model degradation();
Model fleet();

}  // namespace wearwell::formula_model
