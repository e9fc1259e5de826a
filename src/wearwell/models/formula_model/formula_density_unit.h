#pragma once

#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/study/density_unit.h"

namespace wearwell::formula_model {

/// The units of the measured columns, by factor of the likelihood: by unit if units are its
/// factors, else by observation, column by column.
DensityUnit density_unit(const FormulaModel& model);

}  // namespace wearwell::formula_model
