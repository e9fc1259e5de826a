#pragma once

#include <string>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// One chain as CmdStan writes it: comments with #, lp__, the sampler's columns (for NUTS), the
/// parameters in their units.
std::string draws_csv(const PosteriorSummary& result, std::size_t chain);

/// One row a prediction, those of stages first; `rows` is the number of data sets that the
/// posterior knew. Of a study that predicts no measurements but lives and what follows from them one row a
/// quantity, as QuantityQuantiles has it, then one a test: the life of the next under its conditions beside its own.
std::string predictions_csv(const PosteriorSummary& result);

}  // namespace wearwell
