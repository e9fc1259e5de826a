#include "wearwell/base/shown.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

constexpr std::size_t longest_value = 120, longest_word = 400, longest_message = 2400,
                      longest_excerpt = 1500;
constexpr std::size_t kept = 60;  // characters kept at the start of a cut text

/// The start of `text`, whole characters.
std::string_view start_of(std::string_view text, std::size_t bytes) {
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  return text.substr(0, bytes);
}

std::string cut(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return std::string(text);
  return fmt::format("{}... ({} characters)", start_of(text, kept), text.size());
}

/// Cuts long values in single quotes, and long words outside quotes.
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

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  std::string clean = shorten(printable(text));
  if (clean.size() <= longest_message) return clean;
  return fmt::format("{}... ({} characters)", start_of(clean, longest_message), clean.size());
}

/// The position of the excerpt at the end of a message: lines indented by four spaces, the second
/// with a caret, or an example to be copied. The indent distinguishes them from messages. npos
/// without an excerpt.
std::size_t excerpt_in(std::string_view text) {
  constexpr std::string_view indent = "\n    ";
  std::size_t begin = text.npos, caret = text.npos;
  for (std::size_t end = text.size(); end > 0;) {
    const std::size_t line = text.rfind('\n', end - 1);
    if (line == text.npos || !text.substr(line).starts_with(indent)) break;
    caret = begin;
    begin = end = line;
  }
  if (begin == text.npos || text.size() - begin > longest_excerpt) return text.npos;
  if (text.substr(0, begin).ends_with("; for example:")) return begin;
  if (caret == text.npos) return text.npos;
  const std::string_view below = text.substr(caret + 1, text.find('\n', caret + 1) - caret - 1);
  const bool points = below.ends_with('^') && below.find_first_not_of(' ') == below.size() - 1;
  return points ? begin : text.npos;
}

}  // namespace

std::string shown(std::string_view message) {
  std::string text = valid_utf8(message);
  const std::string_view json_class = "[json.exception.";
  for (std::size_t at = 0; (at = text.find(json_class, at)) != text.npos;) {
    const std::size_t end = text.find("] ", at);
    text.erase(at, end == text.npos ? end : end + 2 - at);
  }
  const std::size_t excerpt = excerpt_in(text);
  if (excerpt == text.npos) return on_one_line(std::move(text));
  const std::string first = on_one_line(text.substr(0, excerpt));
  const std::string lines = printable_lines(text.substr(excerpt));
  return first.size() + lines.size() > longest_message ? first : first + lines;
}

}  // namespace wearwell
