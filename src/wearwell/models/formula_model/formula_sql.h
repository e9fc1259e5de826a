#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/dialect.h"
#include "wearwell/formula/program.h"

namespace wearwell::formula_model {

/// An expression of a formula as SQL, in steps that each use earlier ones and are computed once.
/// Its inputs are called formula_x0 (columns, SI), formula_l0 (labels, texts), formula_p0 (parameters, by
/// slots(symbols)), formula_e0 (given by row, in the order of the symbols). A result that is not a
/// number is null, in ClickHouse NaN.
struct FormulaSql {
  struct Step {
    std::string name, expression;
    std::vector<std::string> drawn;  ///< names in it that vary from draw to draw; empty: none
  };
  std::vector<Step> steps;  ///< the last is the value itself
  /// inputs of the expression, ascending
  std::vector<std::size_t> columns, labels, parameters, effects;
};

/// Throws InputError as `compile` does, if the expression depends on earlier rows, or if the engine
/// lacks a function.
FormulaSql formula_sql(const std::vector<formula::Line>& model, const formula::Wanted& wanted,
                       const formula::Symbols& symbols, fleet::Dialect dialect);

}  // namespace wearwell::formula_model
