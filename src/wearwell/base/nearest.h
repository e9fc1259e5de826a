#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wearwell {

/// The candidate with the fewest edits (Levenshtein) from `name`: for "did you mean". `candidates`
/// is not empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace wearwell
