#pragma once

#include <string>

#include "wearwell/report/result.h"

namespace wearwell {

/// The result as aligned tables for people, ending with a newline; with ANSI colours for verdicts
/// when `colour`.
std::string terminal_summary(const StudyResult& result, bool colour);

}  // namespace wearwell
