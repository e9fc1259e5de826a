#include "wearwell/base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace wearwell {
namespace {

// One UTF-8 character, or an invalid byte (size 0).
struct Character {
  std::uint32_t code = 0;
  std::size_t size = 0;
};

Character character_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(at);
  if (first < 0x80) return {first, 1};
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 0;
  if (size == 0 || first > 0xf4 || at + size > text.size()) return {};
  std::uint32_t code = first & (0x7fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(at + i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(at + i) & 0x3f);
  }
  // Accepts only the shortest form and no surrogates.
  static constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < least[size] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {};
  return {code, size};
}

bool commands_a_terminal(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) ||  // C0, DEL, C1
         code == 0x061c || code == 0x200e || code == 0x200f || code == 0x2028 || code == 0x2029 ||
         (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string printable(std::string_view text, std::string_view kept) {
  const auto is_plain = [](char c) { return c >= 0x20 && c < 0x7f; };
  if (std::all_of(text.begin(), text.end(), is_plain)) return std::string(text);
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const Character next = character_at(text, at);
    if (next.size == 0) {
      fmt::format_to(std::back_inserter(out), "\\x{:02x}", static_cast<unsigned char>(text[at++]));
      continue;
    }
    if (!commands_a_terminal(next.code) || (next.size == 1 && kept.find(text[at]) != kept.npos)) {
      out += text.substr(at, next.size);
    } else if (next.code < 0x100) {
      fmt::format_to(std::back_inserter(out), "\\x{:02x}", next.code);
    } else {
      fmt::format_to(std::back_inserter(out), "\\u{:04x}", next.code);
    }
    at += next.size;
  }
  return out;
}

std::string printable_lines(std::string_view text) {
  return printable(text, "\n");
}

std::string printable_json(std::string_view json) {
  // First bytes of such characters: DEL, and lead bytes of two- or three-byte sequences.
  if (json.find_first_of("\x7f\xc2\xd8\xe2") == json.npos) return std::string(json);
  std::string out;
  out.reserve(json.size());
  for (std::size_t at = 0; at < json.size();) {
    const Character next = character_at(json, at);
    const std::size_t size = std::max<std::size_t>(next.size, 1);
    // Line feeds only separate values; the writer escapes them inside texts.
    if (next.size == 0 || json[at] == '\n' || !commands_a_terminal(next.code)) {
      out += json.substr(at, size);
    } else {
      fmt::format_to(std::back_inserter(out), "\\u{:04x}", next.code);
    }
    at += size;
  }
  return out;
}

std::string valid_utf8(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_at(text, at).size;
    out += size > 0 ? text.substr(at, size) : "\xEF\xBF\xBD";
    at += std::max<std::size_t>(size, 1);
  }
  return out;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0) == 0x80) --most;
  return std::string(text.substr(0, most)) + "...";
}

}  // namespace wearwell
