#pragma once

#include <memory>
#include <string>

#include "wearwell/models/formula_model/formula_conditions.h"
#include "wearwell/models/formula_model/life_answers.h"

namespace wearwell::formula_model {

/// What [predict] asks of the subpopulations of a life, or of a life that only a share of parts ends.
struct AskedOfMixture {
  const TomlReader& predict;
  std::shared_ptr<const FormulaModel> model;
  const Conditions& conditions;
  std::string words;  ///< the conditions, as text
  std::string noun;   ///< "unit"
  const AskedOfLife& part;
};

/// Adds the share that fails at all, if it is not all; the share of each subpopulation, of new parts and among those that have
/// survived to the lives of `survival_to` and `survived`; and the life of each subpopulation.
void add_mixture_answers(const AskedOfMixture& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
