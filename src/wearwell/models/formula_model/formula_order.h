#pragma once

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

/// Sorts the rows unit by unit, along the axis where they follow each other. Throws InputError where it is not
/// told which rows do, or along what.
void order_rows(FormulaModel& model, const TomlReader& root);

/// A process that only rises has readings that do, along a unit's rows. Throws InputError.
void require_rising(const FormulaModel& model);

/// Lives without one failure have no upper end but their prior's. Throws InputError.
void require_failures(const FormulaModel& model);

/// A study of lives names the column that says how each ended, where its table has one. Throws InputError.
void require_status(const FormulaModel& model, const TomlReader& root);

}  // namespace wearwell::formula_model
