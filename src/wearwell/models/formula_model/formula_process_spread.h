#pragma once

#include "wearwell/models/formula_model/formula_process_lives.h"
#include "wearwell/models/formula_model/formula_spread.h"

namespace wearwell::formula_model {

/// Forecast band of paths at future positions: of new units, and of observed ones from their
/// present state. `mean` has the column, and as `next` the path of its mean under future
/// conditions. `finer` times as many points of the posterior as a curve needs.
std::vector<Spread> process_spreads(const FormulaRows& rows, const ProcessLimit& mean,
                                    const std::vector<SpreadPath>& paths,
                                    const WeightedDraws& draws, std::size_t finer = 1);

}  // namespace wearwell::formula_model
