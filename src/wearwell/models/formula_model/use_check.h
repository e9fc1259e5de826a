#pragma once

#include <memory>

#include "wearwell/models/formula_model/formula_conditions.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// Adds the check `use`: whether conditions that differ between units (predict.given) lie in the tested range, but for 1 %
/// of the units at either end; and names these conditions in the study's equation. Nothing without such conditions.
void add_use_check(const std::shared_ptr<const FormulaModel>& model, const Conditions& given,
                   PosteriorStudy& study);

}  // namespace wearwell::formula_model
