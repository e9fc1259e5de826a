#pragma once

#include <string>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// Tables with a line for each row of the data, for a terminal; where they are not `shown`, the files
/// that have them.
std::string row_tables(const PosteriorSummary& result, bool shown);

}  // namespace wearwell
