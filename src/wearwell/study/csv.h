#pragma once

#include <string>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// One chain as CmdStan writes it: comments with #, lp__, the sampler's columns (for NUTS), the
/// parameters in their units.
std::string draws_csv(const PosteriorSummary& result, std::size_t chain);

/// One row a prediction, those of stages first; `rows` is the number of data sets that the
/// posterior knew.
std::string predictions_csv(const PosteriorSummary& result);

}  // namespace wearwell
