#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/dialect.h"
#include "wearwell/law/program.h"

namespace wearwell::ownlaw {

/// An expression of a law as SQL, in steps each of which leans on those before and is computed once. What it stands on is
/// called law_x0 (columns, SI), law_l0 (labels, texts), law_p0 (parameters, by slots(symbols)), law_e0 (given by row, in the
/// order of the symbols). What is no number is null, in ClickHouse NaN.
struct LawSql {
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
LawSql law_sql(const std::vector<law::Line>& law, const law::Wanted& wanted,
               const law::Symbols& symbols, fleet::Dialect dialect);

}  // namespace wearwell::ownlaw
