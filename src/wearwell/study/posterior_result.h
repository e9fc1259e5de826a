#pragma once

#include "wearwell/study/posterior_summary.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// The result of a study of a posterior in the form that all commands use: summary.json, the draws,
/// the predictions, and the report if there are plots.
Result posterior_result(PosteriorSummary summary);

}  // namespace wearwell
