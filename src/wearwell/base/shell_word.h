#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace wearwell {

/// A word quoted for a shell, if it needs that.
inline std::string shell_word(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](char each) {
    return std::isalnum(static_cast<unsigned char>(each)) ||
           std::string_view("_-./,=+:").find(each) != std::string_view::npos;
  });
  if (plain) return text;
  std::string quoted = "'";
  for (const char each : text) quoted += each == '\'' ? std::string("'\\''") : std::string(1, each);
  return quoted + "'";
}

}  // namespace wearwell
