#pragma once

#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/models/formula_model/written_mixture.h"

namespace wearwell::formula_model {

/// [use_rate]: the life is measured in use (distance, cycles), units also have an age, and each is used at its own constant
/// rate, use over age, from a distribution over units (prob/use_rate.h). Rows with a known use inform the life and the
/// rate one by one: f(u) or S(u), times g(u/t). A row with an unknown use has an age alone, whose distribution is the
/// integral over the rate.

/// Throws InputError at what is not possible with [use_rate]; `life` is the only likelihood, `rate` that of [use_rate].
void refuse_with_use_rate(const TomlReader& root, const std::vector<WrittenLikelihood>& written,
                          const WrittenLikelihood& rate);

/// Adds the column of rates, empty where the use is. Throws InputError that names the cell: an age that is missing or not
/// positive, a use that is a limit; or no known use.
void add_use_rates(const TomlReader& root, const std::string& use, FormulaData& data);

/// The rates of rows with a known use, `of_use`.
Observed observed_rates(const FormulaData& data, const Observed& of_use);

/// The life in calendar time: without its program, with the ages of rows with an unknown use.
UseRate life_in_time(const TomlReader& root, const Measured& life, const Measured& rate,
                     const FormulaData& data);

/// Failures of units, of known and of unknown use.
std::size_t failures_of_use(const FormulaModel& model);

}  // namespace wearwell::formula_model
