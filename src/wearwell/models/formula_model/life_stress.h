#pragma once

#include "wearwell/infer/fit.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/present/html.h"

namespace wearwell::formula_model {

/// The distribution of a life along one numeric column, all else fixed.
struct LifeStress {
  std::string column;
  /// description of the fixed conditions; may be empty
  Conditions held;
  std::vector<double> at;                                      ///< SI
  std::vector<std::shared_ptr<const LifeDistribution>> lives;  ///< at each of them
  std::vector<LifeGroup> tested;  ///< observations under the fixed conditions
  std::string of_units = {};      ///< how the column differs between units in use; may be empty
  bool of_use = false;  ///< the fixed conditions are those of `given`, not the most frequent ones
};

/// One for each numeric column on which the life depends and that has more than one value among the
/// observations; all else has the values of `given`, or its most frequent ones. Extends to `given`
/// conditions.
std::vector<LifeStress> life_stresses(const TomlReader& root,
                                      const std::shared_ptr<const FormulaModel>& model,
                                      const std::vector<LifeGroup>& groups);

/// Life against the column: the median with its band, B10, and the observations.
html::Figure life_stress_figure(const FormulaModel& model, const LifeStress& stress,
                                const Fit& fit);

}  // namespace wearwell::formula_model
