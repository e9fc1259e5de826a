#pragma once

#include "wearwell/study/posterior_summary.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// The result of a study of a posterior as every command takes it: summary.json, the draws, the
/// predictions, and the report where there are plots.
Result posterior_result(PosteriorSummary summary);

}  // namespace wearwell
