#pragma once

#include <string>
#include <vector>

#include "wearwell/input/sheet_rows.h"

namespace wearwell {

/// Repeats what is merged over several rows in each of them.
class MergedCells {
 public:
  explicit MergedCells(const std::vector<SheetRange>& ranges)
      : ranges_(ranges), values_(ranges.size()) {}

  /// Of each row, in their order.
  void fill(SheetRow& row);
  /// "merged cells A2:A4, A5:A7 read in each of their rows"; empty where none were.
  std::string description() const;

 private:
  const std::vector<SheetRange>& ranges_;
  std::vector<SheetCell> values_;
  std::vector<std::size_t> filled_;
};

}  // namespace wearwell
