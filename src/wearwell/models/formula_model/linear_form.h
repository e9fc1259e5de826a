#pragma once

#include <vector>

#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

struct BoundColumn;

/// Whether an expression of the rows has cases (where, min, max, abs, <), or depends on earlier
/// rows.
bool has_cases(const FormulaModel& model);

/// Parameters at which the form of a formula is tested.
std::vector<std::vector<double>> trial_points(const FormulaModel& model);

/// Whether every column is normal and exact, its mean linear in the random effects, and its
/// standard deviation independent of them: depth = k work, y = a + b t, V = k max(F - F0, 0) s. By
/// the form of the expressions (formula/by_row_degree.h); if that does not decide, and none has cases,
/// numerically at several parameters and effects.
bool is_linear(const FormulaModel& model, const std::vector<BoundColumn>& columns);

}  // namespace wearwell::formula_model
