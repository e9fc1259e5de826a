#pragma once

#include <string>

#include "wearwell/selection/result.h"

namespace wearwell {

/// A selection as aligned tables for the terminal. Only the last line depends on the machine: nodes
/// and seconds.
std::string selection_text(const SelectionResult& result);

/// The prediction error for rows outside the search.
std::string nested_sentence(const Nested& nested);

/// Whether the best model has no constant. Terms are scaled to start at 0, so such a model predicts
/// a zero response at the terms' smallest values.
bool lacks_constant(const SelectionResult& result);
inline constexpr const char* constant_sentence =
    "The best model has no constant: it depends on the origin of the inputs, and on their smallest "
    "values in these data (--force 1 keeps the constant).";

/// The status of a stopped search: best found, bound, gap.
std::string gap_sentence(const SelectionResult& result);

}  // namespace wearwell
