#pragma once

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

/// Sorts the rows unit by unit, along the axis if their order matters. Throws InputError if the
/// unit or the axis is not given.
void order_rows(FormulaModel& model, const TomlReader& root);

/// Checks that readings of an increasing process rise along a unit's rows. Throws InputError.
void require_rising(const FormulaModel& model);

/// Without a failure the upper end of lives comes from the prior alone. Throws InputError for an
/// improper one.
void require_failures(const FormulaModel& model);

/// A study of lives must name its status column, if its table has one. Throws InputError.
void require_status(const FormulaModel& model, const TomlReader& root);

}  // namespace wearwell::formula_model
