#include "wearwell/present/text_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/printable.h"

namespace wearwell {

std::string text_table(const std::vector<std::vector<std::string>>& cells, bool words_last) {
  std::vector<std::vector<std::string>> rows = cells;
  for (auto& row : rows) {
    for (std::string& cell : row) cell = printable(cell);
  }
  std::vector<std::size_t> width;
  for (const auto& row : rows) {
    width.resize(std::max(width.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  }
  std::string out;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (words_last && c + 1 == row.size()) {
        if (!row[c].empty()) out += "  " + row[c];
      } else {
        out += c == 0 ? fmt::format("  {:<{}}", row[c], width[c])
                      : fmt::format("  {:>{}}", row[c], width[c]);
      }
    }
    out += '\n';
  }
  return out;
}

}  // namespace wearwell
