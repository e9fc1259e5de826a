#pragma once

#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// Reads [predict] and adds what it asks for to the study: lives, remaining useful lives, B-lives, survival,
/// acceleration, measurements to come, quantities of the parameters. Throws InputError.
void read_own_predictions(const TomlReader& root, std::shared_ptr<const FormulaModel> model,
                          std::shared_ptr<const FormulaRows> rows, PosteriorStudy& study);

}  // namespace wearwell::formula_model
