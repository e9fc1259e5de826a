#pragma once

#include "wearwell/infer/check.h"
#include "wearwell/infer/fit.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// Whether there are parameters that no data of these rows could tell apart, whatever the priors: a
/// direction in which every slot of every row stays as it is, in k1*k2*x that of k1 up and k2 down. By
/// the rank of the slots' derivatives, at some points of the posterior. Where there is one the check
/// "identified" fails and names the combination.
Check identified(const FormulaRows& rows, const std::vector<Parameter>& parameters, const Fit& fit);

}  // namespace wearwell::formula_model
