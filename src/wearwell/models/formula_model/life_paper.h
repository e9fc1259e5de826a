#pragma once

#include <memory>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// Of a study whose likelihood is of a life: its observations on probability paper of their family with the
/// fitted law and its band under each condition, six to a plot, life against each numeric column that it depends on,
/// and the hazard. Adds to what the study shows.
void show_life_paper(const TomlReader& root, std::shared_ptr<const FormulaModel> model,
                     PosteriorStudy& study);

}  // namespace wearwell::formula_model
