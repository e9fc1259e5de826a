#pragma once

#include <string>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// "life [h]" with safe characters; the name alone if the unit is 1.
std::string printable_heading(const std::string& name, const std::string& unit);

/// Tables with a line for each row of the data, for a terminal; the names of their files if not
/// `shown`.
std::string row_tables(const PosteriorSummary& result, bool shown);

}  // namespace wearwell
