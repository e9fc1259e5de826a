#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/models/formula_model/formula_conditions.h"
#include "wearwell/models/formula_model/formula_life.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// Conditions of a table of [predict], and the life under them.
struct AskedUse {
  std::string key;  ///< "given"
  Conditions conditions;
  std::shared_ptr<const LifeDistribution> life;
};

/// Adds the check `use`: whether conditions that differ between units lie in the tested range, but for 1 % of the units
/// at either end, and whether lives are summed over them finely enough (LifeAtPoint::resolved). Nothing without such
/// conditions.
void add_use_check(const std::shared_ptr<const FormulaModel>& model,
                   const std::vector<AskedUse>& uses, PosteriorStudy& study);

}  // namespace wearwell::formula_model
