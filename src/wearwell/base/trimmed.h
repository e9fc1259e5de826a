#pragma once

#include <string_view>

namespace wearwell {

/// Without blanks, tabs and line ends at its ends; valid while `text` lives.
inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n\f\v";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace wearwell
