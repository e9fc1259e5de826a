#pragma once

#include <string>

#include "wearwell/input/source.h"
#include "wearwell/models/formula_model/written_study.h"

namespace wearwell::formula_model {

/// Reads a distribution from its table, which stands at `place` ("likelihood.life", "failure_modes.wear"), and adds its
/// expressions, and a test by steps or a ramp, to the study. Throws InputError that names the key.
WrittenLikelihood read_likelihood(const TomlReader& table, const std::string& column,
                                  const std::string& place, const Source& source,
                                  WrittenStudy& study);

/// Reads the shares of a life, and adds their expressions to the study.
void read_shares(const TomlReader& table, WrittenLikelihood& written, WrittenStudy& study);

/// The table of a likelihood.
TomlReader table_of(const TomlReader& root, const WrittenLikelihood& written);

/// Its column, or that of the lower limits; null if there is neither.
const NumberColumn* measured_column(const FormulaData& data, const WrittenLikelihood& written);

/// Throws InputError: the column of a likelihood is no numeric column under [data.columns].
[[noreturn]] void fail_without_column(const TomlReader& root, const FormulaData& data,
                                      const WrittenLikelihood& written);

/// "nearest: 'depth'" in brackets, from the numeric columns; empty without any.
std::string nearest_column(const FormulaData& data, const std::string& name);

}  // namespace wearwell::formula_model
