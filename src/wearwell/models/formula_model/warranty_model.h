#pragma once

#include "wearwell/study/model.h"

namespace wearwell::formula_model {

/// Formula models with the template of `wearwell new warranty`, a returns triangle.
Model warranty();

}  // namespace wearwell::formula_model
