#pragma once

#include <vector>

#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// From so many rows of a column on it is tried: fewer cost little.
inline constexpr std::size_t gathered_from = 10'000;

/// The same columns with few rows in place of many: those under equal conditions are gathered
/// (prob/gathered_responses.h), and `count` is no whole number. For sums over all rows alone: `term` says nothing. Empty where rows
/// depend on each other or on a unit, or where any column has fewer rows or keeps more than a fourth of them.
std::vector<BoundColumn> gathered_columns(const FormulaModel& model,
                                          const std::vector<BoundColumn>& columns);

}  // namespace wearwell::formula_model
