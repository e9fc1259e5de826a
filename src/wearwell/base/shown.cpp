#include "wearwell/base/shown.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

constexpr std::size_t longest_value = 120, longest_word = 400, longest_message = 2400;
constexpr std::size_t kept = 60;  // of what is cut, at its start

/// The start of `text`, whole characters.
std::string_view start_of(std::string_view text, std::size_t bytes) {
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  return text.substr(0, bytes);
}

std::string cut(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return std::string(text);
  return fmt::format("{}... ({} characters)", start_of(text, kept), text.size());
}

/// Values stand in single quotes; cuts the long ones, and long words outside of quotes.
std::string shorten(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const bool opens = text.front() == '\'' && text.find('\'', 1) != text.npos;
    if (opens) {
      const std::size_t end = text.find('\'', 1);
      result += fmt::format("'{}'", cut(text.substr(1, end - 1), longest_value));
      text.remove_prefix(end + 1);
      continue;
    }
    if (text.front() == ' ') {
      result += ' ';
      text.remove_prefix(1);
      continue;
    }
    const std::size_t end = std::min(text.find_first_of(" '", 1), text.size());
    result += cut(text.substr(0, end), longest_word);
    text.remove_prefix(end);
  }
  return result;
}

}  // namespace

std::string shown(std::string_view message) {
  std::string text = valid_utf8(message);
  const std::string_view json_class = "[json.exception.";
  for (std::size_t at = 0; (at = text.find(json_class, at)) != text.npos;) {
    const std::size_t end = text.find("] ", at);
    text.erase(at, end == text.npos ? end : end + 2 - at);
  }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  std::string clean = shorten(printable(text));
  if (clean.size() <= longest_message) return clean;
  return fmt::format("{}... ({} characters)", start_of(clean, longest_message), clean.size());
}

}  // namespace wearwell
