#pragma once

#include "wearwell/models/formula_model/classical_estimates.h"
#include "wearwell/present/html.h"

namespace wearwell::formula_model {

/// Nonparametric survival as steps with its pointwise band (`deviate` standard errors), and the
/// maximum likelihood estimate as a line, of up to six conditions.
html::Figure survival_figure(const AskedOfClassics& asked, const ClassicalEstimates& found,
                             double deviate);

}  // namespace wearwell::formula_model
