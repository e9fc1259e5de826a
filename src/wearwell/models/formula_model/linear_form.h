#pragma once

#include <vector>

#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

struct BoundColumn;

/// Whether an expression of the rows has cases (where, min, max, abs, <), or they depend on rows before.
bool has_cases(const FormulaModel& model);

/// Parameters at which the form of a law is tried.
std::vector<std::vector<double>> trial_points(const FormulaModel& model);

/// Whether every column is normal and exact, its mean a straight line in what differs from unit to
/// unit, and its standard deviation without it: depth = k work, y = a + b t, V = k max(F - F0, 0) s. By the form of the
/// expressions (formula/by_row_degree.h); where that does not say, and none has cases, tried with numbers at several
/// parameters and effects.
bool is_linear(const FormulaModel& model, const std::vector<BoundColumn>& columns);

}  // namespace wearwell::formula_model
