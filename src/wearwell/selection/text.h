#pragma once

#include <string>

#include "wearwell/selection/result.h"

namespace wearwell {

/// A selection as aligned tables for people. The last line alone depends on the machine: nodes and
/// seconds.
std::string selection_text(const SelectionResult& result);

/// How a stopped search stands: best found, bound, gap.
std::string gap_sentence(const SelectionResult& result);

}  // namespace wearwell
