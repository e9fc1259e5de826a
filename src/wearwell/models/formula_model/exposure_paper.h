#pragma once

#include <memory>

#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {

/// For lives under a stress that changes (steps, a ramp), which have no common axis: a probability plot of the standardized
/// exposures. Each specimen stands at the share that the fit expects failed by its exposure, and points are the observed
/// share; a fit that holds is the diagonal. Adds to the figures of the study.
void show_exposure_paper(std::shared_ptr<const FormulaModel> model, PosteriorStudy& study);

}  // namespace wearwell::formula_model
