#pragma once

#include <string>

#include "wearwell/selection/result.h"

namespace wearwell {

/// A selection as aligned tables for people. The last line alone depends on the machine: nodes and
/// seconds.
std::string selection_text(const SelectionResult& result);

/// What is known of rows that the search has not seen.
std::string nested_sentence(const Nested& nested);

/// Whether the best model holds no constant. Terms are scaled to begin at 0, so such a model says
/// that the response vanishes where they have their least values.
bool lacks_constant(const SelectionResult& result);
inline constexpr const char* constant_sentence =
    "The best model holds no constant: it depends on where the inputs have their zero, and on "
    "their "
    "least values in these data (--force 1 keeps the constant).";

/// How a stopped search stands: best found, bound, gap.
std::string gap_sentence(const SelectionResult& result);

}  // namespace wearwell
