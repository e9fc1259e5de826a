#pragma once

#include <memory>

#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

/// Reads a study except [predict]: columns, constants, formula, likelihoods, priors, random
/// effects. Throws InputError.
std::shared_ptr<FormulaModel> read_formula_model(const TomlReader& root, const Source& source);

/// An expression of the study's parameters only, or of anything, compiled with errors at its key.
formula::Program compile_at(const TomlReader& table, const std::string& key,
                            const std::vector<formula::Line>& lines, const formula::Wanted& wanted,
                            const formula::Symbols& symbols);

/// The text of an expression: a text, or a plain number.
std::string expression(const TomlReader& table, const std::string& key);

}  // namespace wearwell::formula_model
