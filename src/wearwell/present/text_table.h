#pragma once

#include <string>
#include <vector>

namespace wearwell {

/// Maximum width of terminal output in characters, unless a single word is longer.
inline constexpr std::size_t text_width = 100;

/// Wraps text at blanks to at most `text_width` characters; the first line is indented by `indent`,
/// the others by `hanging`. Ends with a newline.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t hanging);
inline std::string wrapped(const std::string& text, std::size_t indent = 0) {
  return wrapped(text, indent, indent);
}

/// An aligned table for a terminal, with cells made printable(); columns after the first are
/// right-aligned. With `words_last` the last column is text, left-aligned. A row with one cell in a
/// wider table is a heading of the rows after it. A table wider than `text_width` is wrapped: first
/// words into lines, then columns into tables below each other, each with the first column.
std::string text_table(const std::vector<std::vector<std::string>>& cells, bool words_last = false);

}  // namespace wearwell
