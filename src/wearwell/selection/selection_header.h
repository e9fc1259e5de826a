#pragma once

#include "wearwell/selection/result.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// What the summary.json of a selection begins with, as that of a study. Checks: whether the search
/// came to its end, and whether rows that it has not seen are predicted better than by their mean.
Header selection_header(const SelectionResult& result);

}  // namespace wearwell
