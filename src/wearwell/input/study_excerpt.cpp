#include "wearwell/input/study_excerpt.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

constexpr std::size_t widest = 100;  // maximum number of characters shown

bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
}

/// The byte at which character `column` (from 1) begins; the end if there are fewer.
std::size_t byte_of(std::string_view line, std::size_t column) {
  std::size_t at = 0;
  for (; at < line.size(); ++at) {
    if (begins_character(line[at]) && --column == 0) break;
  }
  return at;
}

std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

/// Lines are UTF-8, because TOML is.
std::string plain(std::string_view text) {
  std::string blank(text);
  std::replace(blank.begin(), blank.end(), '\t', ' ');
  return printable(blank);
}

bool is_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether the text at `at` is a whole word; decimals belong to a number.
bool stands_alone(std::string_view line, std::size_t at, std::string_view word) {
  const std::size_t end = at + word.size();
  const auto goes_on = [](char last, char next) {
    return is_word(last) && (is_word(next) || (is_digit(last) && next == '.'));
  };
  return !(at > 0 && goes_on(word.front(), line[at - 1])) &&
         !(end < line.size() && goes_on(word.back(), line[end]));
}

std::size_t find_behind(std::string_view line, std::size_t place, std::string_view word) {
  std::size_t at = line.find(word, place);
  while (at != line.npos && !stands_alone(line, at, word)) at = line.find(word, at + 1);
  return at;
}

/// A key precedes its value; for a table both begin at the bracket.
std::size_t find_wrong(std::string_view line, std::size_t place, const Repair& repair) {
  const std::string_view front = line.substr(0, place);
  for (std::size_t at = repair.is_key ? front.rfind(repair.wrong) : front.npos; at != front.npos;
       at = at == 0 ? front.npos : front.rfind(repair.wrong, at - 1)) {
    if (stands_alone(line, at, repair.wrong)) return at;
  }
  return find_behind(line, place, repair.wrong);
}

}  // namespace

std::string study_excerpt(std::string_view text, std::size_t line, std::size_t column,
                          const Repair& repair) {
  if (line == 0 || column == 0) return {};
  std::size_t start = 0;
  for (std::size_t i = 1; i < line; ++i) {
    start = text.find('\n', start);
    if (start == text.npos) return {};
    ++start;
  }
  std::string_view whole = text.substr(start, text.find('\n', start) - start);
  if (whole.ends_with('\r')) whole.remove_suffix(1);
  if (whole.empty()) return {};
  const std::size_t place = byte_of(whole, column);
  const std::size_t indent = std::min(whole.find_first_not_of(" \t"), place);
  const std::string before = plain(whole.substr(indent, place - indent)),
                    behind = plain(whole.substr(place));
  if (width(before) + width(behind) > widest) {
    // Shows the end of the preceding text, and as much of the following text as fits.
    const std::size_t shown = std::min(width(before), widest / 2);
    const std::size_t cut = byte_of(before, width(before) - shown + 1);
    const std::size_t end = std::min(byte_of(behind, widest - shown + 1), behind.size());
    return fmt::format("\n    {}{}{}{}\n    {}^", cut ? "..." : "", before.substr(cut),
                       behind.substr(0, end), end < behind.size() ? "..." : "",
                       std::string((cut ? 3 : 0) + shown, ' '));
  }
  std::string excerpt =
      fmt::format("\n    {}{}\n    {}^", before, behind, std::string(width(before), ' '));
  if (repair.wrong.empty()) return excerpt;
  const std::size_t at = find_wrong(whole, place, repair);
  if (at == whole.npos || at < indent) return excerpt;
  const std::string_view rest = whole.substr(at + repair.wrong.size());
  return excerpt + fmt::format("\n    right: {}{}{}", plain(whole.substr(indent, at - indent)),
                               plain(repair.right), plain(rest));
}

std::string without_excerpt(const std::string& message) {
  return message.substr(0, message.find("\n    "));
}

}  // namespace wearwell
