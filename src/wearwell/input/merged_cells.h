#pragma once

#include <string>
#include <vector>

#include "wearwell/input/sheet_rows.h"

namespace wearwell {

/// Repeats the content of cells merged over several rows in each of these rows.
class MergedCells {
 public:
  explicit MergedCells(const std::vector<SheetRange>& ranges)
      : ranges_(ranges), values_(ranges.size()) {}

  /// Call for each row, in order.
  void fill(SheetRow& row);
  /// "merged cells A2:A4, A5:A7 read in each of their rows"; empty if there are none.
  std::string description() const;

 private:
  const std::vector<SheetRange>& ranges_;
  std::vector<SheetCell> values_;
  std::vector<std::size_t> filled_;
};

}  // namespace wearwell
