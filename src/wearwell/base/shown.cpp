#include "wearwell/base/shown.h"

#include <fmt/format.h>

#include <algorithm>

namespace wearwell {
namespace {

constexpr std::size_t longest_value = 120, longest_word = 400, longest_message = 2400;
constexpr std::size_t kept = 60;  // of what is cut, at its start

/// Bytes of the UTF-8 character at the start of `text`; 0 where there is none.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, halves of pairs, and beyond U+10FFFF.
  const bool wrong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
                     (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F);
  return wrong ? 0 : length;
}

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

std::string valid_utf8(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    result += length > 0 ? text.substr(0, length) : "\xEF\xBF\xBD";
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::string shown(std::string_view message) {
  std::string text = valid_utf8(message);
  const std::string_view json_class = "[json.exception.";
  for (std::size_t at = 0; (at = text.find(json_class, at)) != text.npos;) {
    const std::size_t end = text.find("] ", at);
    text.erase(at, end == text.npos ? end : end + 2 - at);
  }
  std::string clean;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool c1 = byte == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (byte == '\n' || byte == '\t') {
      clean += ' ';
    } else if (c1) {
      clean += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[++i]));
    } else if (byte < 0x20 || byte == 0x7F) {
      clean += fmt::format("\\x{:02x}", byte);
    } else {
      clean += text[i];
    }
  }
  clean = shorten(clean);
  if (clean.size() <= longest_message) return clean;
  return fmt::format("{}... ({} characters)", start_of(clean, longest_message), clean.size());
}

}  // namespace wearwell
