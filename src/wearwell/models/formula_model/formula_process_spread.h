#pragma once

#include "wearwell/models/formula_model/formula_process_lives.h"
#include "wearwell/models/formula_model/formula_spread.h"

namespace wearwell::formula_model {

/// What is known of paths of a process at places ahead: of new units, and of those seen from where they
/// stand. `mean` has the column, and as `next` the path of its mean under the conditions to come. `finer` times as many points of the
/// posterior as are enough for a curve.
std::vector<Spread> process_spreads(const FormulaRows& rows, const ProcessLimit& mean,
                                    const std::vector<SpreadPath>& paths,
                                    const WeightedDraws& draws, std::size_t finer = 1);

}  // namespace wearwell::formula_model
