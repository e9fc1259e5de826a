#pragma once

#include <string>

namespace wearwell {

/// Quotes a name or a text for SQL; doubles quotes inside.
inline std::string quoted(const std::string& text, char quote) {
  std::string out(1, quote);
  for (const char c : text) out += c == quote ? std::string(2, c) : std::string(1, c);
  return out + quote;
}

}  // namespace wearwell
