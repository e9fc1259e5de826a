#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell {

/// The candidate nearest to `name`: the fewest edits (insertion, deletion, substitution,
/// transposition), ignoring case. A candidate that contains `name` as a word precedes one with two
/// edits. `candidates` is not empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// The same if it is near enough to suggest: at most two edits and at most half of the name.
std::optional<std::string> near_name(std::string_view name,
                                     const std::vector<std::string>& candidates);

/// "; did you mean 'NAME'?", or nothing.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace wearwell
