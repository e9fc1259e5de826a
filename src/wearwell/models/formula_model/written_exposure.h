#pragma once

#include "wearwell/models/formula_model/written_study.h"

/// Steps and ramps of a study: what is read once its table is, and once the names in its expressions are known.
namespace wearwell::formula_model {

/// Adds the columns of the exposure to the data of `model`. Throws InputError at what is not possible with steps or a ramp.
void read_exposure(const TomlReader& root, const WrittenStudy& study, FormulaModel& model);

/// Writes the threshold of a ramp in the likelihood of the life, and its lines in `model`.
void add_ramp_exposure(const TomlReader& root, WrittenStudy& study, FormulaModel& model);

/// Throws InputError if a parameter other than the scale depends on what changes between the steps of a specimen.
void require_step_exposure(const TomlReader& root, const WrittenStudy& study,
                           const FormulaModel& model);

}  // namespace wearwell::formula_model
