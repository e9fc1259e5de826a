#pragma once

#include <string>

#include "wearwell/present/terminal_style.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The result as aligned tables for people, ending with a newline.
std::string terminal_summary(const PosteriorSummary& result, const TerminalStyle& style);

}  // namespace wearwell
