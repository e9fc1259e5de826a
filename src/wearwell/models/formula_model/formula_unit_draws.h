#pragma once

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// A posterior with the effects of a unit of the study: points of the parameters, followed by the
/// unit's effects at the nodes of their integral, over at most 500 points of the posterior.
WeightedDraws with_unit(const FormulaRows& rows, std::size_t unit, const WeightedDraws& draws);

}  // namespace wearwell::formula_model
