#include "wearwell/input/merged_cells.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace wearwell {

void MergedCells::fill(SheetRow& row) {
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const SheetRange& range = ranges_[i];
    if (row.number < range.first.row || row.number > range.last.row) continue;
    const auto at = std::lower_bound(
        row.cells.begin(), row.cells.end(), range.first.column,
        [](const SheetCell& cell, std::size_t column) { return cell.column < column; });
    const bool there = at != row.cells.end() && at->column == range.first.column;
    if (row.number == range.first.row) {
      if (there) values_[i] = *at;
    } else if (!there && values_[i].column > 0) {
      row.cells.insert(at, values_[i]);
      if (filled_.empty() || filled_.back() != i) filled_.push_back(i);
    }
  }
}

std::string MergedCells::description() const {
  constexpr std::size_t most = 3;
  std::vector<std::string> names;
  for (const std::size_t i : filled_) {
    const SheetRange& range = ranges_[i];
    if (names.size() == most) {
      names.push_back(fmt::format("... ({} in all)", filled_.size()));
      break;
    }
    names.push_back(fmt::format("{}{}:{}{}", column_letters(range.first.column), range.first.row,
                                column_letters(range.last.column), range.last.row));
  }
  if (names.empty()) return {};
  return fmt::format("merged cells {} read in each of their rows", fmt::join(names, ", "));
}

}  // namespace wearwell
