#pragma once

#include <string>

#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

/// Throws InputError that names the cause if C export does not support the scatter of a measured
/// column, or readings are not exact numbers.
void refuse_formula(const FormulaModel& model);

/// C99 that computes the parameters of all measured columns, the sum of their log densities, and
/// whether anything was measured.
void add_likelihood(const FormulaModel& model, std::string& functions, std::string& sum,
                    std::string& measured);

/// Position of a measured column among the numbers of a row.
std::size_t measured_column(const FormulaModel& model, std::size_t m);

}  // namespace wearwell::formula_model
