#pragma once

#include <memory>

#include "wearwell/infer/fit_check.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// Residuals of lives by failure mode: row by row for the first mode, then for the next. In each mode the
/// failures by others are run-outs. A mode that is not known, and a life within an interval, are drawn from what
/// they can be under the same parameters, so that residuals stay standard normal under a correct model.
FitData mode_fit_data(std::shared_ptr<const FormulaRows> rows);

/// A score of a drawn value: it is no measurement, so that tests that need exact ones leave it out.
NormalScore as_drawn(const NormalScore& score);

}  // namespace wearwell::formula_model
