#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell {

/// The candidate that was probably meant by `name`: the fewest edits (a letter more, less, another,
/// or two swapped), capitals aside; a candidate one of whose words is `name` comes before one with
/// two slips. `candidates` is not empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// The same where it is near enough to be offered: no more than two slips, nor than half of the
/// name.
std::optional<std::string> near_name(std::string_view name,
                                     const std::vector<std::string>& candidates);

/// "; did you mean 'NAME'?", or nothing.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace wearwell
