#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/models/formula_model/life_answers.h"

namespace wearwell::formula_model {

/// What [predict] asks of the failure modes of a part.
struct AskedOfModes {
  const TomlReader& predict;
  std::shared_ptr<const FormulaModel> model;
  const Conditions& conditions;
  std::string words;  ///< the conditions, as text
  std::string noun;   ///< "unit"
  const AskedOfLife& part;
};

/// Adds the answers about modes: the life that each mode alone would give, the life of a part with one mode
/// designed out, and the share that has failed by each mode (cumulative incidence) at the lives of
/// `survival_to`; and a figure of these shares against life.
void add_mode_answers(const AskedOfModes& asked, PosteriorStudy& study);

}  // namespace wearwell::formula_model
