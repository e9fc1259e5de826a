#pragma once

#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/study/density_unit.h"

namespace wearwell::formula_model {

/// The units of the measured columns, factor by factor of the likelihood: units where these are its factors, else
/// observations, column by column.
DensityUnit density_unit(const FormulaModel& model);

}  // namespace wearwell::formula_model
