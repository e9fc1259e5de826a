#pragma once

#include <string>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// One chain in CmdStan's format: comments with #, lp__, the sampler's columns (for NUTS), the
/// parameters in their units.
std::string draws_csv(const PosteriorSummary& result, std::size_t chain);

/// One row per prediction, those of stages first; `rows` is the number of data sets in the
/// posterior. A study that predicts lives instead of measurements has one row per quantity
/// (QuantityQuantiles), then one per test: its life and the predicted life of a new item under the
/// same conditions.
std::string predictions_csv(const PosteriorSummary& result);

}  // namespace wearwell
