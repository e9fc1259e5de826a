#pragma once

#include "wearwell/models/ownlaw/own_process_lives.h"
#include "wearwell/models/ownlaw/own_spread.h"

namespace wearwell::ownlaw {

/// What is known of paths of a process at places ahead: of new units, and of those seen from where they
/// stand. `mean` has the column, and as `next` the path of its mean under the conditions to come. `finer` times as many points of the
/// posterior as are enough for a curve.
std::vector<Spread> process_spreads(const OwnRows& rows, const ProcessLimit& mean,
                                    const std::vector<SpreadPath>& paths,
                                    const WeightedDraws& draws, std::size_t finer = 1);

}  // namespace wearwell::ownlaw
