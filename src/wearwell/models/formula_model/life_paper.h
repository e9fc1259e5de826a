#pragma once

#include <memory>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// For a study whose likelihood is of a life: its observations on probability paper of their family
/// with the fitted distribution and its band under each condition, six to a plot; life against each
/// numeric column that it depends on; and the hazard. Adds to the figures of the study.
void show_life_paper(const TomlReader& root, std::shared_ptr<const FormulaModel> model,
                     PosteriorStudy& study);

/// The probability plot of a step-stress or ramp test, at equivalent ages (exposure_lives.h).
void show_exposure_paper(const TomlReader& root, std::shared_ptr<const FormulaModel> model,
                         std::shared_ptr<const FormulaRows> rows, PosteriorStudy& study);

}  // namespace wearwell::formula_model
