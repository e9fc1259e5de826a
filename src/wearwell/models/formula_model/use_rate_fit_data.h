#pragma once

#include <memory>

#include "wearwell/infer/fit_check.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// Residuals of lives in use, then of rates of use, row by row. Rows with a known use are often those that failed, which
/// are no sample of all: so an unknown use is drawn, given the age and under the same parameters, and residuals of
/// all rows together stay standard normal under a correct model.
FitData use_rate_fit_data(std::shared_ptr<const FormulaRows> rows);

}  // namespace wearwell::formula_model
