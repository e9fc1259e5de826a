#pragma once

#include "wearwell/selection/result.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// The start of the summary.json of a selection, as that of a study. Checks: whether the search was
/// completed, and whether rows outside the search are predicted better than by their mean.
Header selection_header(const SelectionResult& result);

}  // namespace wearwell
