#pragma once

#include <string>

#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

/// Throws InputError, with what it is, where the scatter of a measured column has no C of ours, or readings are more than exact
/// numbers.
void refuse_formula(const FormulaModel& model);

/// C99 of the slots of all measured columns, of the sum of their log densities, and of whether anything was measured.
void add_likelihood(const FormulaModel& model, std::string& functions, std::string& sum,
                    std::string& measured);

/// Where a measured column stands among the numbers of a row.
std::size_t measured_column(const FormulaModel& model, std::size_t m);

}  // namespace wearwell::formula_model
