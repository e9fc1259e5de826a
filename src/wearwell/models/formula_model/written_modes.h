#pragma once

#include <vector>

#include "wearwell/models/formula_model/written_study.h"

namespace wearwell::formula_model {

/// Reads [failure_modes]: replaces the one likelihood of the study by those of the modes, and the lines that depend on the mode
/// by a copy for each. Returns the observations of each mode; nothing without failure modes. Throws InputError.
std::vector<Observed> read_modes(const TomlReader& root, WrittenStudy& study, FormulaModel& model);

}  // namespace wearwell::formula_model
