#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/number_text.h"
#include "wearwell/input/table_settings.h"
#include "wearwell/input/text_layout.h"

namespace wearwell {

/// A cell that shows something, and its row of data.
struct CellWitness {
  std::size_t row = 0, line = 0;
  std::string cell;
};

/// What the cells of a column show of its numbers.
struct ColumnEvidence {
  std::optional<CellWitness> decimal[2], doubtful[2];  // of '.' and ','
  std::set<char> thousands;
  bool any_number = false, any_text = false;
  bool other_signs = false;  ///< such as no C number has
  // Cells that are more than a number, or none.
  std::optional<CellWitness> missing, limit, bare, with_unit, other_unit;
  std::size_t missing_cells = 0, limits = 0;
  std::string unit;  ///< of `with_unit`

  bool shows(std::size_t mark) const { return decimal[mark].has_value(); }
  bool agrees_with(const NumberMarks& marks) const;
  /// Whether its numbers are as C has them.
  bool is_plain(char decimal_mark) const {
    if (!thousands.empty() || other_signs || missing || shows(1) || doubtful[1]) return false;
    return decimal_mark == '.' || (!shows(0) && !doubtful[0]);
  }
};

/// What a cell shows of its column; `row` counts rows of data, from 1.
void look_at(std::string_view cell, std::size_t row, std::size_t line, ColumnEvidence& seen);

/// The decimal mark that the columns of numbers show; 0 where they show none, '?' where both.
char shown_by_all(const std::vector<ColumnEvidence>& all);

/// Which marks the numbers of a column have and whether it is one of numbers alone, or why nobody can tell.
void decide_marks(const ColumnEvidence& seen, char of_all, const std::vector<ColumnEvidence>& all,
                  char delimiter, const TableSettings& settings, TextColumn& column);

/// The unit in the cells of a column of numbers, or why nobody can tell.
void decide_unit(const ColumnEvidence& seen, TextColumn& column);

/// Whether what was seen so far settles every column, whatever follows.
bool is_settled(const std::vector<ColumnEvidence>& all, char delimiter);

/// Where '.' and ',' stand in `decimal` and `doubtful`, and what stands there.
inline constexpr char decimal_signs[2] = {'.', ','};
inline std::size_t mark_place(char mark) {
  return mark == ',';
}

}  // namespace wearwell
