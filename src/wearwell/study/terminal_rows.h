#pragma once

#include <string>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// "life [h]" as it may be shown; the name alone where the unit is 1.
std::string printable_heading(const std::string& name, const std::string& unit);

/// Tables with a line for each row of the data, for a terminal; where they are not `shown`, the files
/// that have them.
std::string row_tables(const PosteriorSummary& result, bool shown);

}  // namespace wearwell
