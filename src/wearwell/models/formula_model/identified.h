#pragma once

#include "wearwell/infer/check.h"
#include "wearwell/infer/fit.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// Structural identifiability: whether some direction in the parameters leaves every distribution
/// parameter of every row unchanged, as k1 up and k2 down does in k1*k2*x. Such data cannot
/// separate these parameters under any prior. Uses the rank of the derivatives at some points of
/// the posterior. If there is such a direction, the check "identified" fails and names the
/// combination.
Check identified(const FormulaRows& rows, const std::vector<Parameter>& parameters, const Fit& fit);

}  // namespace wearwell::formula_model
