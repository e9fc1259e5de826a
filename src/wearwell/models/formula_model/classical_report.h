#pragma once

#include "wearwell/models/formula_model/classical_estimates.h"

namespace wearwell::formula_model {

/// The estimates for the study's result: key `classical` of summary.json, tables and figures of the
/// section of predictions, and text for a terminal.
PresetAddition classical_addition(const AskedOfClassics& asked, const DensityUnit& density,
                                  const Fit& fit);

}  // namespace wearwell::formula_model
