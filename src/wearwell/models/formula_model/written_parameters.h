#pragma once

#include "wearwell/models/formula_model/written_study.h"

namespace wearwell::formula_model {

/// Reads [prior]: the parameters of `model` and their symbols, in the order of the file, with a value for each level of its label
/// where an expression has an index. `drawn` are the effects that are drawn. Throws InputError that names the key.
void read_parameters(const TomlReader& root, const WrittenStudy& study,
                     const std::vector<WrittenEffects>& drawn, FormulaModel& model);

}  // namespace wearwell::formula_model
