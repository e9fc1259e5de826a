#pragma once

#include <string>
#include <vector>

namespace wearwell {

/// What is printed for people is so many characters wide at most, where no single word is longer.
inline constexpr std::size_t text_width = 100;

/// Text in lines of at most `text_width` characters, broken at blanks: the first `indent` from the
/// left, the others `hanging`. Ends with a newline.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t hanging);
inline std::string wrapped(const std::string& text, std::size_t indent = 0) {
  return wrapped(text, indent, indent);
}

/// An aligned table for a terminal, cells as printable() shows them; columns after the first are
/// aligned right. With `words_last` the last column is of words, aligned left. A row of one cell in a
/// table of more is a heading of the rows after it. What is wider than `text_width` is folded: first
/// words into lines, then columns into tables below each other, each with the first column.
std::string text_table(const std::vector<std::vector<std::string>>& cells, bool words_last = false);

}  // namespace wearwell
