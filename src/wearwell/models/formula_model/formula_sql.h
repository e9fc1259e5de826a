#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/dialect.h"
#include "wearwell/formula/program.h"

namespace wearwell::formula_model {

/// An expression of a law as SQL, in steps each of which leans on those before and is computed once. What it stands on is
/// called formula_x0 (columns, SI), formula_l0 (labels, texts), formula_p0 (parameters, by slots(symbols)), formula_e0 (given by row, in the
/// order of the symbols). What is no number is null, in ClickHouse NaN.
struct FormulaSql {
  struct Step {
    std::string name, expression;
    std::vector<std::string>
        drawn;  ///< names in it that differ from draw to draw; empty: it does not
  };
  std::vector<Step> steps;                                        ///< the last is the value itself
  std::vector<std::size_t> columns, labels, parameters, effects;  ///< that it stands on, ascending
};

/// Throws InputError as `compile` does, where the expression depends on rows before its own, and for what the engine cannot
/// compute.
FormulaSql formula_sql(const std::vector<formula::Line>& model, const formula::Wanted& wanted,
                       const formula::Symbols& symbols, fleet::Dialect dialect);

}  // namespace wearwell::formula_model
