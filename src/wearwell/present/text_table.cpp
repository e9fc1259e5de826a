#include "wearwell/present/text_table.h"

#include <algorithm>
#include <numeric>

#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>;

constexpr std::size_t gap = 2;            // before each column
constexpr std::size_t least_words = 30;   // minimum width of a wrapped column of words
constexpr std::size_t widest_first = 44;  // maximum width of the first column of a split table
constexpr std::size_t further = 2;        // indent of the lines of a cell after its first

// Counts characters, not bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

std::string blanks(std::size_t count) {
  return std::string(count, ' ');
}

// Leading blanks of the text indent each line.
std::vector<std::string> lines_of(const std::string& text, std::size_t first, std::size_t others) {
  std::vector<std::string> lines(1);
  std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t lead = begin;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t most = lines.size() == 1 ? first : others;
    std::string& line = lines.back();
    if (!line.empty() && lead + width_of(line) + 1 + width_of(word) > most) {
      lines.push_back(word);
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
  }
  for (std::string& line : lines) line.insert(0, lead, ' ');
  return lines;
}

std::vector<std::size_t> widths_of(const Rows& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) widths.resize(std::max(widths.size(), row.size()));
  for (const Row& row : rows) {
    if (row.size() == 1 && widths.size() > 1) continue;  // a heading
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width_of(row[c]));
  }
  return widths;
}

std::size_t total(const std::vector<std::size_t>& widths) {
  return std::accumulate(widths.begin(), widths.end(), widths.size() * gap);
}

// Wraps a cell of words to the width of its column; the first column begins with its gap.
std::string in_lines(const Row& row, const std::vector<std::size_t>& widths, bool words_last) {
  const std::size_t last = widths.size() - 1;
  const auto first_lines = lines_of(row[0], widths[0], std::max(widths[0], further + 1) - further);
  const bool words = words_last && row.size() == widths.size() && last > 0;
  const auto last_lines = words ? lines_of(row[last], widths[last], widths[last]) : Row{};
  std::string out;
  for (std::size_t i = 0; i < std::max(first_lines.size(), last_lines.size()); ++i) {
    std::string line = blanks(gap);
    if (i < first_lines.size()) line += blanks(i > 0 ? further : 0) + first_lines[i];
    const auto fill_to = [&](std::size_t column) {
      line += blanks(column > width_of(line) ? column - width_of(line) : 0);
    };
    std::size_t at = gap + widths[0];
    for (std::size_t c = 1; c < row.size(); ++c) {
      at += gap + widths[c];
      if (words && c == last) {
        if (i >= last_lines.size() || last_lines[i].empty()) continue;
        fill_to(at - widths[c]);
        line += last_lines[i];
      } else if (i == 0) {
        fill_to(at - widths[c]);
        line += blanks(widths[c] - width_of(row[c])) + row[c];
      }
    }
    // Does not pad an empty last column.
    out += (words ? line.substr(0, line.find_last_not_of(' ') + 1) : line) + '\n';
  }
  return out;
}

std::string in_lines(const Rows& rows, const std::vector<std::size_t>& widths, bool words_last) {
  std::string out;
  for (const Row& row : rows) {
    out += row.size() == 1 && widths.size() > 1 ? wrapped(row[0], gap, gap + further)
                                                : in_lines(row, widths, words_last);
  }
  return out;
}

// Splits columns that do not fit side by side into tables below each other.
std::string folded(const Rows& rows, std::vector<std::size_t> widths) {
  widths[0] = std::min(widths[0], widest_first);
  std::string out;
  for (std::size_t begin = 1; begin < widths.size();) {
    std::size_t end = begin, taken = gap + widths[0];
    while (end < widths.size() && (end == begin || taken + gap + widths[end] <= text_width))
      taken += gap + widths[end++];
    std::vector<std::size_t> shown = {widths[0]};
    shown.insert(shown.end(), widths.begin() + static_cast<std::ptrdiff_t>(begin),
                 widths.begin() + static_cast<std::ptrdiff_t>(end));
    Rows part;
    for (const Row& row : rows) {
      part.push_back({row[0]});
      for (std::size_t c = begin; c < std::min(end, row.size()); ++c) part.back().push_back(row[c]);
    }
    if (begin > 1) out += '\n';
    out += in_lines(part, shown, false);
    begin = end;
  }
  return out;
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t indent, std::size_t hanging) {
  std::string out;
  std::size_t at = indent;
  for (const std::string& line : lines_of(text, text_width - indent, text_width - hanging)) {
    out += blanks(at) + line + '\n';
    at = hanging;
  }
  return out;
}

std::string text_table(const std::vector<std::vector<std::string>>& cells, bool words_last) {
  Rows rows = cells;
  for (Row& row : rows) {
    for (std::string& cell : row) cell = printable(cell);
  }
  std::vector<std::size_t> widths = widths_of(rows);
  if (widths.empty()) return "";
  const auto shrink = [&](std::size_t column, std::size_t least) {
    const std::size_t all = total(widths);
    if (all <= text_width || widths[column] <= least) return;
    const std::size_t excess = all - text_width;
    widths[column] = widths[column] > excess + least ? widths[column] - excess : least;
  };
  if (words_last) shrink(widths.size() - 1, least_words);
  shrink(0, least_words);
  if (total(widths) <= text_width || widths.size() < 3 || words_last)
    return in_lines(rows, widths, words_last);
  return folded(rows, widths_of(rows));
}

}  // namespace wearwell
