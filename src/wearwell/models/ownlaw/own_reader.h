#pragma once

#include <memory>

#include "wearwell/models/ownlaw/own_law.h"

namespace wearwell::ownlaw {

/// Reads all of a study but [predict]: columns, constants, law, likelihoods, priors, what varies.
/// Throws InputError.
std::shared_ptr<OwnLaw> read_own_law(const TomlReader& root, const Source& source);

/// An expression of the study's parameters alone, or of anything, compiled with errors at its key.
law::Program compile_at(const TomlReader& table, const std::string& key,
                        const std::vector<law::Line>& lines, const law::Wanted& wanted,
                        const law::Symbols& symbols);

/// The text of an expression: a text, or a plain number.
std::string expression(const TomlReader& table, const std::string& key);

}  // namespace wearwell::ownlaw
