#pragma once

#include <string>

#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// A histogram of the draws of each parameter, one line each, for a terminal.
std::string histogram_lines(const PosteriorSummary& result);

}  // namespace wearwell
